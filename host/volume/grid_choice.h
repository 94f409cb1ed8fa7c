#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "volume/volume_formats.h"

namespace parhelion {

/// A grid of a file that may hold several, also of one name.
struct NamedGrid {
    std::string name;
    std::string type;         ///< for messages
    bool isReadable = false;  ///< of a type that is read here
    std::string number = {};  ///< what the file itself tells it by from others of its name; "" if it does not say
};

struct GridChoice {
    std::size_t index;
    std::string label;  ///< its name; with its number ("density[1]") if others have the name
    std::string note;   ///< which others there were, or empty
};

/// Chooses the grid to read: the first readable one of the wanted name; without a wanted name the first one named
/// "density", else the first. "density[1]" wants the second grid named "density", as OpenVDB writes it: grids of one
/// name are counted from 0, unless the file numbers them itself.
///
/// @param types  those that are read, for messages.
/// @throws InputError listing the grids if there is no such grid.
GridChoice chooseGrid(std::span<const NamedGrid> grids, std::string_view types, const VolumeBytes& input);

}  // namespace parhelion
