#include <Imath/half.h>
#include <blosc.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "volume/grid_choice.h"
#include "volume/sparse_volume.h"
#include "volume/vdb_header.h"

// OpenVDB's own reader trusts the lengths in the file: a damaged one makes it write past its buffers. This one
// checks them, and goes from the file to the bricks without a second tree in memory. Layout: OpenVDB 10,
// openvdb/tree/{RootNode,InternalNode,LeafNode}.h (readTopology, readBuffers) and io/Compression.h.

namespace parhelion {

namespace {

constexpr std::string_view kFloatTree = "Tree_float_5_4_3";

/// What is stored beside a node's values (the byte in front of them).
enum class Inactive : std::uint8_t {
    kBackground,           ///< all inactive values are the background
    kMinusBackground,      ///< all are minus the background
    kOneValue,             ///< all are one stored value
    kMaskBothBackgrounds,  ///< a mask chooses between background and minus background
    kMaskOneValue,         ///< ... between background and a stored value
    kMaskTwoValues,        ///< ... between two stored values
    kStored,               ///< every value is stored
};

class VdbTreeReader {
public:
    VdbTreeReader(ByteReader& reader, const VdbGridHead& head) : reader_(reader), head_(head) {}

    void readTopology(SparseTree& tree);
    void readLeaf(float* values);

private:
    void readInternal(SparseTree& tree, glm::i64vec3 origin, unsigned log2Edge, unsigned log2ChildEdge);
    void readTiles(SparseTree& tree, glm::i64vec3 origin, unsigned log2Edge, unsigned log2ChildEdge,
                   const std::byte* children, const std::byte* active);
    /// Reads the values of a node of `count` voxels or tiles with value mask `active`.
    void readValues(std::size_t count, const std::byte* active, float* values);
    void readStored(std::size_t count, float* values);
    void readChunk(std::span<std::byte> target);
    void decompress(std::span<const std::byte> chunk, std::span<std::byte> target);

    ByteReader& reader_;
    const VdbGridHead& head_;
    float background_ = 0;
    std::vector<std::byte> scratch_;
};

glm::i64vec3 positionInNode(std::size_t index, unsigned log2Count) {
    const std::size_t mask = (std::size_t(1) << log2Count) - 1;
    return {index >> (2 * log2Count), (index >> log2Count) & mask, index & mask};
}

void VdbTreeReader::readTopology(SparseTree& tree) {
    if (const auto buffers = reader_.read<std::int32_t>("the buffer count"); buffers != 1)
        reader_.fail(fmt::format("damaged: a tree must have 1 buffer; got {}", buffers));
    tree.background = background_ = reader_.read<float>("the background value");
    const auto tiles = reader_.read<std::uint32_t>("the number of tiles");
    const auto children = reader_.read<std::uint32_t>("the number of nodes");
    constexpr unsigned kLog2Edge = 12;
    for (std::uint32_t i = 0; i < tiles; ++i) {
        const glm::i64vec3 origin = reader_.read<glm::ivec3>("a tile's origin");
        const auto value = reader_.read<float>("a tile's value");
        const bool isActive = reader_.read<std::uint8_t>("a tile's state") != 0;
        constexpr std::int64_t kEdge = std::int64_t(1) << kLog2Edge;
        if (isActive)
            tree.activeTiles.push_back({origin, kEdge, value});
        else if (value != 0.0f && value != background_)
            tree.inactiveNonZero += std::uint64_t(kEdge) * kEdge * kEdge;
    }
    for (std::uint32_t i = 0; i < children; ++i)
        readInternal(tree, reader_.read<glm::ivec3>("a node's origin"), kLog2Edge, 7);
}

void VdbTreeReader::readInternal(SparseTree& tree, glm::i64vec3 origin, unsigned log2Edge, unsigned log2ChildEdge) {
    const unsigned log2Count = log2Edge - log2ChildEdge;
    const std::size_t count = std::size_t(1) << (3 * log2Count);
    const std::byte* children = reader_.take(count / 8, "a node's child mask").data();
    const std::byte* active = reader_.take(count / 8, "a node's value mask").data();
    readTiles(tree, origin, log2Edge, log2ChildEdge, children, active);
    for (std::size_t i = 0; i < count; ++i) {
        if (!isOn(children, i)) continue;
        const glm::i64vec3 childOrigin = origin + (positionInNode(i, log2Count) << std::int64_t(log2ChildEdge));
        if (log2ChildEdge == 3)
            tree.leaves.push_back({childOrigin, reader_.take(kLeafVoxels / 8, "a leaf's value mask").data()});
        else
            readInternal(tree, childOrigin, log2ChildEdge, 3);
    }
}

void VdbTreeReader::readTiles(SparseTree& tree, glm::i64vec3 origin, unsigned log2Edge, unsigned log2ChildEdge,
                              const std::byte* children, const std::byte* active) {
    const unsigned log2Count = log2Edge - log2ChildEdge;
    const std::int64_t edge = std::int64_t(1) << log2ChildEdge;
    std::vector<float> values(std::size_t(1) << (3 * log2Count));
    readValues(values.size(), active, values.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (isOn(children, i)) continue;
        if (isOn(active, i))
            tree.activeTiles.push_back({origin + positionInNode(i, log2Count) * edge, edge, values[i]});
        else if (values[i] != 0.0f && values[i] != background_)
            tree.inactiveNonZero += edge * edge * edge;
    }
}

void VdbTreeReader::readLeaf(float* values) {
    const std::byte* active = reader_.take(kLeafVoxels / 8, "a leaf's value mask").data();
    readValues(kLeafVoxels, active, values);
}

void VdbTreeReader::readValues(std::size_t count, const std::byte* active, float* values) {
    const auto inactive = reader_.read<Inactive>("a node's compression");
    if (inactive > Inactive::kStored)
        reader_.fail(fmt::format("damaged: a node's compression must be 0 to 6; got {}", int(inactive)));
    float first = inactive == Inactive::kBackground ? background_ : -background_;
    float second = background_;
    const bool hasFirst =
        inactive == Inactive::kOneValue || inactive == Inactive::kMaskOneValue || inactive == Inactive::kMaskTwoValues;
    if (hasFirst) first = reader_.read<float>("an inactive value");
    if (inactive == Inactive::kMaskTwoValues) second = reader_.read<float>("an inactive value");
    const bool hasMask = inactive >= Inactive::kMaskBothBackgrounds && inactive <= Inactive::kMaskTwoValues;
    const std::byte* chooseSecond = hasMask ? reader_.take(count / 8, "a node's selection mask").data() : nullptr;

    if (!head_.isMaskCompressed || inactive == Inactive::kStored) return readStored(count, values);
    std::vector<float> stored;
    for (std::size_t i = 0; i < count; ++i)
        if (isOn(active, i)) stored.push_back(0.0f);
    readStored(stored.size(), stored.data());
    std::size_t next = 0;
    for (std::size_t i = 0; i < count; ++i)
        values[i] = isOn(active, i) ? stored[next++] : chooseSecond && isOn(chooseSecond, i) ? second : first;
}

void VdbTreeReader::readStored(std::size_t count, float* values) {
    if (!head_.isHalf) return readChunk(std::as_writable_bytes(std::span(values, count)));
    if (count == 0) return;  // OpenVDB writes nothing, not even a length
    std::vector<std::uint16_t> halves(count);
    readChunk(std::as_writable_bytes(std::span(halves)));
    std::ranges::transform(halves, values, [](std::uint16_t bits) { return imath_half_to_float(bits); });
}

void VdbTreeReader::readChunk(std::span<std::byte> target) {
    if (!head_.isZip && !head_.isBlosc) {
        std::ranges::copy(reader_.take(target.size(), "values"), target.begin());
        return;
    }
    // A length <= 0 says that compression did not pay: minus the length of the plain values.
    const auto length = reader_.read<std::int64_t>("the length of compressed values");
    if (length > 0) return decompress(reader_.take(length, "compressed values"), target);
    if (static_cast<std::uint64_t>(0) - static_cast<std::uint64_t>(length) != target.size())
        reader_.fail(fmt::format("damaged: {} bytes of values must follow; got {}", target.size(), length));
    std::ranges::copy(reader_.take(target.size(), "values"), target.begin());
}

void VdbTreeReader::decompress(std::span<const std::byte> chunk, std::span<std::byte> target) {
    bool complete = false;
    if (head_.isZip) {
        uLongf size = target.size();
        const int status = uncompress(reinterpret_cast<Bytef*>(target.data()), &size,
                                      reinterpret_cast<const Bytef*>(chunk.data()), chunk.size());
        complete = status == Z_OK && size == target.size();
    } else {
        std::size_t size = 0;
        complete = blosc_cbuffer_validate(chunk.data(), chunk.size(), &size) == 0 && size == target.size() &&
                   blosc_decompress_ctx(chunk.data(), target.data(), target.size(), 1) == int(target.size());
    }
    if (!complete) reader_.fail("damaged: values cannot be decompressed");
}

GridChoice chooseEntry(const std::vector<VdbGridEntry>& entries, const VolumeBytes& input) {
    std::vector<NamedGrid> grids;
    for (const VdbGridEntry& entry : entries)
        grids.push_back({entry.name, entry.type + (entry.isInstance ? ", instance" : ""),
                         entry.type == kFloatTree && !entry.isInstance, entry.number});
    return chooseGrid(grids, kFloatTree, input);
}

}  // namespace

Volume readOpenVdbVolume(const VolumeBytes& input) {
    ByteReader header(input.bytes, input.where);
    const std::vector<VdbGridEntry> entries = readVdbHeader(header);
    const GridChoice choice = chooseEntry(entries, input);
    const VdbGridEntry& entry = entries[choice.index];

    ByteReader reader(input.bytes.first(entry.end), input.where);
    reader.take(entry.begin, "the grids before");
    const VdbGridHead head = readVdbGridHead(reader, entry);
    SparseTree tree;
    tree.gridName = choice.label;
    tree.note = choice.note;
    tree.transform = head.transform;
    VdbTreeReader treeReader(reader, head);
    treeReader.readTopology(tree);

    SparseVolumeBuilder builder(tree, input);
    std::array<float, kLeafVoxels> values;
    for (const SparseTree::Leaf& leaf : tree.leaves) {
        treeReader.readLeaf(values.data());
        builder.addLeaf(leaf, values.data());
    }
    if (reader.remaining() > 0)
        reader.fail(fmt::format("damaged: the grid must end here; {} bytes remain", reader.remaining()));
    return builder.finish();
}

}  // namespace parhelion
