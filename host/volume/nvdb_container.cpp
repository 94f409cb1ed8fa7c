#include "volume/nvdb_container.h"

#include <blosc.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

namespace parhelion {

namespace {

// nanovdb::io trusts the lengths in the file; this container reader checks them. Layout: NanoVDB 32,
// nanovdb/util/IO.h (Header, MetaData, Internal::read).
struct SegmentHeader {
    char magic[8];
    std::uint32_t version;
    std::uint16_t gridCount;
    std::uint16_t codec;
};
static_assert(sizeof(SegmentHeader) == 16);

struct GridMetadata {
    std::uint64_t gridBytes, fileBytes, nameKey, voxelCount;
    nanovdb::GridType type;
    std::uint32_t gridClass;
    double worldBox[6];
    std::int32_t indexBox[6];
    double voxelSize[3];
    std::uint32_t nameBytes;
    std::uint32_t nodeCounts[4];
    std::uint32_t tileCounts[3];
    std::uint16_t codec, padding;
    std::uint32_t version;
};
static_assert(sizeof(GridMetadata) == 176);

enum Codec : std::uint16_t { kNone, kZip, kBlosc };

constexpr std::uint64_t kChunkBytes = 1ull << 30;  // blosc compresses at most this much at once

// Deflate expands at most 1032 times, LZ4 255 times: a larger claim is damage, not a reason to allocate.
constexpr std::uint64_t kLargestExpansion = 1032;

void checkSegment(const ByteReader& reader, const SegmentHeader& header) {
    const std::string_view magic(header.magic, sizeof(header.magic));
    if (magic != "NanoVDB0" && magic != "NanoVDB2")
        reader.fail("a segment must start with NanoVDB0 or NanoVDB2 (a raw grid, NanoVDB1, is not supported)");
    checkNvdbVersion(reader, header.version);
    if (header.codec > kBlosc)
        reader.fail(fmt::format("codec must be 0 (none), 1 (zip) or 2 (blosc); got {}", header.codec));
    if (header.gridCount == 0) reader.fail("damaged: a segment must hold a grid; got 0");
}

NvdbGridEntry readMetadata(ByteReader& reader, std::uint16_t codec, std::uint64_t& fileBytes) {
    const auto metadata = reader.read<GridMetadata>("a grid's metadata");
    const auto name = reader.take(metadata.nameBytes, "a grid's name");
    const auto end = std::ranges::find(name, std::byte{0});
    if (metadata.codec != codec)
        reader.fail(fmt::format("damaged: a grid's codec must be its segment's {}; got {}", codec, metadata.codec));
    const std::uint64_t largest =
        codec == kNone ? metadata.fileBytes
                       : (metadata.fileBytes > reader.remaining() ? 0 : metadata.fileBytes * kLargestExpansion);
    if (metadata.gridBytes > largest || (codec == kNone && metadata.gridBytes != metadata.fileBytes))
        reader.fail(fmt::format("truncated or damaged: a grid of {} bytes cannot come from {} bytes",
                                metadata.gridBytes, metadata.fileBytes));
    fileBytes = metadata.fileBytes;
    return {{reinterpret_cast<const char*>(name.data()), static_cast<std::size_t>(end - name.begin())},
            metadata.type,
            codec,
            metadata.gridBytes,
            {}};
}

bool decodeChunk(std::span<const std::byte> chunk, std::span<std::byte> target, std::uint16_t codec) {
    if (codec == kZip) {
        uLongf size = target.size();
        return uncompress(reinterpret_cast<Bytef*>(target.data()), &size, reinterpret_cast<const Bytef*>(chunk.data()),
                          chunk.size()) == Z_OK &&
               size == target.size();
    }
    std::size_t size = 0;
    return blosc_cbuffer_validate(chunk.data(), chunk.size(), &size) == 0 && size == target.size() &&
           blosc_decompress_ctx(chunk.data(), target.data(), target.size(), 1) == static_cast<int>(target.size());
}

}  // namespace

void checkNvdbVersion(const ByteReader& reader, std::uint32_t version) {
    if (const std::uint32_t major = version >> 21; major != NANOVDB_MAJOR_VERSION_NUMBER)
        reader.fail(fmt::format("NanoVDB version must be {}.x; got {}.{}", NANOVDB_MAJOR_VERSION_NUMBER, major,
                                version >> 10 & 0x7ff));
}

std::vector<NvdbGridEntry> readNvdbEntries(ByteReader& reader) {
    std::vector<NvdbGridEntry> entries;
    while (reader.remaining() > 0) {
        const auto header = reader.read<SegmentHeader>("a segment's header");
        checkSegment(reader, header);
        std::vector<std::uint64_t> sizes(header.gridCount);
        const std::size_t first = entries.size();
        for (std::uint64_t& size : sizes) entries.push_back(readMetadata(reader, header.codec, size));
        for (std::size_t i = 0; i < sizes.size(); ++i) entries[first + i].data = reader.take(sizes[i], "a grid's data");
    }
    return entries;
}

std::vector<NvdbBlock> decodeNvdbGrid(const NvdbGridEntry& entry, const SourceLocation& where) {
    std::vector<NvdbBlock> blocks((entry.gridBytes + sizeof(NvdbBlock) - 1) / sizeof(NvdbBlock));
    std::span<std::byte> target(reinterpret_cast<std::byte*>(blocks.data()), entry.gridBytes);
    if (entry.codec == kNone) {
        std::ranges::copy(entry.data, target.begin());
        return blocks;
    }
    ByteReader reader(entry.data, where);
    while (!target.empty()) {
        const std::span<std::byte> part =
            target.first(entry.codec == kZip ? target.size() : std::min<std::uint64_t>(target.size(), kChunkBytes));
        const auto chunk = reader.take(reader.read<std::uint64_t>("a chunk's length"), "a chunk");
        if (!decodeChunk(chunk, part, entry.codec))
            throw InputError(where, fmt::format("damaged: grid \"{}\" cannot be decompressed", entry.name));
        target = target.subspan(part.size());
    }
    return blocks;
}

}  // namespace parhelion
