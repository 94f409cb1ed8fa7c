#include <blosc.h>
#include <fmt/format.h>

#include <random>

#include "volume/byte_writer.h"
#include "volume/vdb_leaves.h"
#include "volume/volume_formats.h"

// Reading OpenVDB's headers would cost the build more than every other file of the program. Layout: OpenVDB 10,
// openvdb/io/{Archive,File,GridDescriptor,Compression}.cc, math/Maps.h and openvdb/tree/{RootNode,InternalNode,
// LeafNode}.h (writeTopology, writeBuffers).

namespace parhelion {

namespace {

constexpr std::uint32_t kActiveMask = 2, kBlosc = 4;  // compression flags
constexpr std::uint8_t kAllInactiveAreBackground = 0;

/// Masks of a node: a bit for each child or voxel, 64-bit words.
template <std::size_t Count>
using Mask = std::array<std::uint64_t, Count / 64>;

template <std::size_t Count>
void setOn(Mask<Count>& mask, std::size_t index) {
    mask[index / 64] |= std::uint64_t(1) << (index % 64);
}

/// Position of a child in a node of edge^3 children: z fastest.
std::size_t indexInNode(glm::uvec3 child, unsigned edge) { return (child.x * edge + child.y) * edge + child.z; }

class VdbWriter {
public:
    VdbWriter(const std::filesystem::path& file, const Volume& volume)
        : writer_(file), volume_(volume), leaves_(vdbLeaves(volume.density)) {}

    void write();

private:
    void writeText(std::string_view text);
    void writeMetadata(std::string_view name, std::string_view type, std::span<const std::byte> value);
    void writeGridMetadata();
    void writeTransform();
    void writeTopology();
    void writeUpper(std::span<const VdbLeaf> leaves);
    void writeLower(std::span<const VdbLeaf> leaves);
    void writeLeaf(const VdbLeaf& leaf);
    void writeValues(std::span<const float> active);

    ByteWriter writer_;
    const Volume& volume_;
    std::vector<VdbLeaf> leaves_;  ///< in the order of the tree
};

/// Version 4 of RFC 4122.
std::string randomIdentifier() {
    std::random_device random;
    const std::uint32_t a = random(), b = random(), c = random(), d = random();
    return fmt::format("{:08x}-{:04x}-4{:03x}-{:04x}-{:04x}{:08x}", a, b >> 16, b & 0xfffu, 0x8000u | (c >> 18),
                       c & 0xffffu, d);
}

void VdbWriter::write() {
    writer_.write(std::uint64_t{0x56444220});
    for (const std::uint32_t version : {224u, 10u, 0u}) writer_.write(version);  // of the file, of the library
    writer_.write(std::uint8_t{1});                                              // grids have offsets
    const std::string identifier = randomIdentifier();
    writer_.write(identifier.data(), identifier.size());
    writer_.write(std::uint32_t{0});  // no metadata of the file's
    writer_.write(std::uint32_t{1});  // grids

    for (const std::string_view text : {"density", "Tree_float_5_4_3", ""}) writeText(text);  // the last: no instance
    const std::uint64_t offsets = writer_.position();
    for (int i = 0; i < 3; ++i) writer_.write(std::uint64_t{0});
    const std::uint64_t begin = writer_.position();
    writer_.write(kActiveMask | kBlosc);
    writeGridMetadata();
    writeTransform();
    writeTopology();
    const std::uint64_t blocks = writer_.position();
    for (const VdbLeaf& leaf : leaves_) writeLeaf(leaf);
    const std::uint64_t end = writer_.position();
    writer_.seek(offsets);
    for (const std::uint64_t offset : {begin, blocks, end}) writer_.write(offset);
    writer_.close();
}

void VdbWriter::writeText(std::string_view text) {
    writer_.write(static_cast<std::uint32_t>(text.size()));
    writer_.write(text.data(), text.size());
}

void VdbWriter::writeMetadata(std::string_view name, std::string_view type, std::span<const std::byte> value) {
    writeText(name);
    writeText(type);
    writer_.write(static_cast<std::uint32_t>(value.size()));
    writer_.write(value.data(), value.size());
}

void VdbWriter::writeGridMetadata() {
    const glm::ivec3 first(0), last(volume_.density.resolution() - 1u);
    std::int64_t active = 0;
    for (const VdbLeaf& leaf : leaves_) active += static_cast<std::int64_t>(leaf.values.size());
    const auto bytes = [](const auto& value) { return std::as_bytes(std::span(&value, 1)); };
    writer_.write(std::uint32_t{5});
    writeMetadata("class", "string", std::as_bytes(std::span(std::string_view("fog volume"))));
    writeMetadata("file_bbox_max", "vec3i", bytes(last));
    writeMetadata("file_bbox_min", "vec3i", bytes(first));
    writeMetadata("file_voxel_count", "int64", bytes(active));
    writeMetadata("name", "string", std::as_bytes(std::span(std::string_view("density"))));
}

void VdbWriter::writeTransform() {
    const VdbPlacement placement = vdbPlacement(volume_);
    const glm::dvec3 scale = placement.voxelSize;
    writeText("ScaleTranslateMap");
    for (const glm::dvec3& vector :
         {placement.firstCentre, scale, scale, 1.0 / scale, 1.0 / (scale * scale), 0.5 / scale})
        writer_.write(vector);
}

/// Calls visit(leaves) for every run of leaves that share an ancestor of `edge` voxels.
template <typename Visit>
void forEachNode(std::span<const VdbLeaf> leaves, unsigned edge, const Visit& visit) {
    while (!leaves.empty()) {
        const glm::uvec3 node = leaves.front().origin / edge;
        std::size_t count = 1;
        while (count < leaves.size() && leaves[count].origin / edge == node) ++count;
        visit(leaves.first(count));
        leaves = leaves.subspan(count);
    }
}

void VdbWriter::writeTopology() {
    writer_.write(std::int32_t{1});   // buffers
    writer_.write(0.0f);              // background
    writer_.write(std::uint32_t{0});  // tiles
    std::uint32_t nodes = 0;
    forEachNode(leaves_, kVdbUpperEdge, [&](std::span<const VdbLeaf>) { ++nodes; });
    writer_.write(nodes);
    forEachNode(leaves_, kVdbUpperEdge, [&](std::span<const VdbLeaf> leaves) {
        writer_.write(glm::ivec3(leaves.front().origin / kVdbUpperEdge * kVdbUpperEdge));
        writeUpper(leaves);
    });
}

void VdbWriter::writeUpper(std::span<const VdbLeaf> leaves) {
    constexpr unsigned kEdge = kVdbUpperEdge / kVdbLowerEdge;
    Mask<kEdge * kEdge * kEdge> children{};
    const Mask<kEdge * kEdge * kEdge> activeTiles{};
    for (const VdbLeaf& leaf : leaves)
        setOn<kEdge * kEdge * kEdge>(children, indexInNode(leaf.origin / kVdbLowerEdge % kEdge, kEdge));
    writer_.write(children);
    writer_.write(activeTiles);
    writeValues({});
    forEachNode(leaves, kVdbLowerEdge, [&](std::span<const VdbLeaf> below) { writeLower(below); });
}

void VdbWriter::writeLower(std::span<const VdbLeaf> leaves) {
    constexpr unsigned kEdge = kVdbLowerEdge / kLeafEdge;
    Mask<kEdge * kEdge * kEdge> children{};
    const Mask<kEdge * kEdge * kEdge> activeTiles{};
    for (const VdbLeaf& leaf : leaves)
        setOn<kEdge * kEdge * kEdge>(children, indexInNode(leaf.origin / kLeafEdge % kEdge, kEdge));
    writer_.write(children);
    writer_.write(activeTiles);
    writeValues({});
    for (const VdbLeaf& leaf : leaves) writer_.write(leaf.active);
}

void VdbWriter::writeLeaf(const VdbLeaf& leaf) {
    writer_.write(leaf.active);
    writeValues(leaf.values);
}

/// A node's values: the active ones alone, as those of a fog volume are zero elsewhere.
void VdbWriter::writeValues(std::span<const float> active) {
    writer_.write(kAllInactiveAreBackground);
    std::array<std::byte, kLeafVoxels * sizeof(float) + BLOSC_MAX_OVERHEAD> packed;
    const int size = active.empty() ? 0
                                    : blosc_compress_ctx(9, BLOSC_SHUFFLE, sizeof(float), active.size_bytes(),
                                                         active.data(), packed.data(), active.size_bytes(),
                                                         BLOSC_LZ4_COMPNAME, active.size_bytes(), 1);
    if (size > 0) {
        writer_.write(std::int64_t{size});
        writer_.write(packed.data(), size);
    } else {  // compression does not pay
        writer_.write(-static_cast<std::int64_t>(active.size_bytes()));
        writer_.write(active.data(), active.size_bytes());
    }
}

}  // namespace

void writeOpenVdbVolume(const std::filesystem::path& file, const Volume& volume) { VdbWriter(file, volume).write(); }

}  // namespace parhelion
