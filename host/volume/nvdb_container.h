#pragma once

#include <nanovdb/NanoVDB.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "volume/byte_reader.h"

namespace parhelion {

/// One grid of a .nvdb file, as its metadata announces it.
struct NvdbGridEntry {
    std::string name;
    nanovdb::GridType type;
    std::uint16_t codec;              ///< 0 none, 1 zip, 2 blosc
    std::uint64_t gridBytes;          ///< decoded
    std::span<const std::byte> data;  ///< encoded
};

/// Reads the headers of all segments; every grid lies within the file.
std::vector<NvdbGridEntry> readNvdbEntries(ByteReader& reader);

/// Memory for a decoded grid, aligned as NanoVDB's structures need.
struct alignas(32) NvdbBlock {
    std::byte bytes[32];
};

/// @throws InputError when the data does not decode to exactly gridBytes.
std::vector<NvdbBlock> decodeNvdbGrid(const NvdbGridEntry& entry, const SourceLocation& where);

/// Whether this program reads files and grids of NanoVDB `version` (major 32: one layout).
void checkNvdbVersion(const ByteReader& reader, std::uint32_t version);

}  // namespace parhelion
