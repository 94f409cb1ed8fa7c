#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "volume/byte_reader.h"
#include "volume/sparse_volume.h"

namespace parhelion {

/// One grid of a .vdb file, as its descriptor announces it.
struct VdbGridEntry {
    std::string name;
    std::string number;  ///< that tells it from others of the same name; empty if there are none
    std::string type;    ///< e.g. "Tree_float_5_4_3", without the suffix of half-float storage
    bool isHalf = false;
    bool isInstance = false;  ///< shares the tree of another grid
    std::uint64_t begin = 0;  ///< byte range of the grid in the file
    std::uint64_t end = 0;
};

/// Reads file header, metadata and grid descriptors, and checks that every grid lies within the file.
std::vector<VdbGridEntry> readVdbHeader(ByteReader& reader);

/// What precedes the tree of a grid.
struct VdbGridHead {
    bool isZip = false;
    bool isBlosc = false;
    bool isMaskCompressed = false;  ///< only active values are stored
    bool isHalf = false;
    GridTransform transform;
};

/// @throws InputError unless the transform is a scale > 0 per axis and a translation.
VdbGridHead readVdbGridHead(ByteReader& reader, const VdbGridEntry& entry);

}  // namespace parhelion
