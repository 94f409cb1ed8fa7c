#pragma once

#include <optional>

#include "compile/compiled_scene.h"
#include "volume/density_grid.h"

namespace parhelion {

/// A volume as a medium's extinction: grey, or with a value a channel. Channels that are equal everywhere fold to grey.
///
/// The volume must outlive it.
class ExtinctionGrid {
public:
    explicit ExtinctionGrid(const Volume& volume);

    /// What majorants bound: the density itself, or the largest channel of each voxel.
    const DensityGrid& largest() const { return folded_ ? *folded_ : volume_->density; }
    /// Three values a voxel, or null where the channels are equal.
    const ColorGrid* color() const { return isColored_ ? &volume_->color : nullptr; }

private:
    const Volume* volume_;
    std::optional<DensityGrid> folded_;  ///< of a volume of three channels
    bool isColored_ = false;
};

/// The largest value of any channel.
float largestValue(const Volume& volume);

}  // namespace parhelion
