#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>

#include "volume/grid_choice.h"
#include "volume/nvdb_container.h"
#include "volume/sparse_volume.h"

namespace parhelion {

namespace {

/// Walks a decoded grid through NanoVDB's own structures. Its accessors follow offsets blindly, so every node's
/// place is checked before it is touched.
template <typename BuildT>
class NanoTreeReader {
public:
    using Root = typename nanovdb::NanoRoot<BuildT>::DataType;
    using Upper = typename nanovdb::NanoUpper<BuildT>::DataType;
    using Lower = typename nanovdb::NanoLower<BuildT>::DataType;
    using Leaf = typename nanovdb::NanoLeaf<BuildT>::DataType;

    NanoTreeReader(std::span<const std::byte> grid, const GridChoice& choice, const SourceLocation& where)
        : grid_(grid), where_(where) {
        tree_.gridName = choice.label;
        tree_.note = choice.note;
    }

    Volume read(const VolumeBytes& input);

private:
    static constexpr std::uint64_t kTree = sizeof(nanovdb::GridData);
    static constexpr std::uint64_t kFirstNode = kTree + sizeof(nanovdb::TreeData<3>);

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(where_, "damaged: grid \"" + tree_.gridName + "\": " + message);
    }

    /// The T at `base + offset` bytes, if it lies whole and aligned behind the grid's header.
    template <typename T>
    const T* nodeAt(std::uint64_t base, std::int64_t offset, std::uint64_t bytes = sizeof(T)) const;
    template <typename T>
    std::uint64_t positionOf(const T* node) const {
        return static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(node) - grid_.data());
    }

    void readHead();
    void checkChecksum(const nanovdb::GridData& head, std::uint64_t rootEnd) const;
    void readRoot(const Root& root);
    template <typename Node>
    void readInternal(const Node& node, glm::i64vec3 origin);
    void readChild(const Upper& parent, std::int64_t offset, glm::i64vec3 origin);
    void readChild(const Lower& parent, std::int64_t offset, glm::i64vec3 origin);
    void addTile(glm::i64vec3 origin, std::int64_t edge, float value, bool isActive);

    std::span<const std::byte> grid_;
    SourceLocation where_;
    SparseTree tree_;
    std::vector<const Leaf*> leaves_;  // beside tree_.leaves
    std::uint64_t lowerNodes_ = 0;
};

template <typename BuildT>
template <typename T>
const T* NanoTreeReader<BuildT>::nodeAt(std::uint64_t base, std::int64_t offset, std::uint64_t bytes) const {
    const std::uint64_t position = base + static_cast<std::uint64_t>(offset);  // wraps for damaged offsets
    if (position < kFirstNode || position > grid_.size() || grid_.size() - position < bytes ||
        position % NANOVDB_DATA_ALIGNMENT != 0)
        fail(fmt::format("a node at byte {} does not fit into {} bytes", position, grid_.size()));
    return reinterpret_cast<const T*>(grid_.data() + position);
}

template <typename BuildT>
Volume NanoTreeReader<BuildT>::read(const VolumeBytes& input) {
    readHead();
    SparseVolumeBuilder builder(tree_, input);
    std::array<float, kLeafVoxels> values;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        for (unsigned v = 0; v < kLeafVoxels; ++v) values[v] = leaves_[i]->getValue(v);
        builder.addLeaf(tree_.leaves[i], values.data());
    }
    return builder.finish();
}

template <typename BuildT>
void NanoTreeReader<BuildT>::readHead() {
    if (grid_.size() < kFirstNode)
        fail(fmt::format("it must have at least {} bytes; got {}", kFirstNode, grid_.size()));
    const auto& head = *reinterpret_cast<const nanovdb::GridData*>(grid_.data());
    if (std::memcmp(&head.mMagic, "NanoVDB", 7) != 0) fail("it must start with NanoVDB");
    if (head.mGridSize > grid_.size()) fail(fmt::format("it must have {} bytes; got {}", head.mGridSize, grid_.size()));
    std::array<double, 9> matrix;
    std::copy_n(head.mMap.mMatD, 9, matrix.begin());
    tree_.transform = makeGridTransform(where_, matrix, {head.mMap.mVecD[0], head.mMap.mVecD[1], head.mMap.mVecD[2]});

    const auto& tree = *reinterpret_cast<const nanovdb::TreeData<3>*>(grid_.data() + kTree);
    const auto* root = nodeAt<Root>(kTree, static_cast<std::int64_t>(tree.mNodeOffset[3]));
    const std::uint64_t rootBytes = sizeof(Root) + std::uint64_t(root->mTableSize) * sizeof(typename Root::Tile);
    nodeAt<Root>(positionOf(root), 0, rootBytes);
    checkChecksum(head, positionOf(root) + rootBytes);
    readRoot(*root);
}

template <typename BuildT>
void NanoTreeReader<BuildT>::checkChecksum(const nanovdb::GridData& head, std::uint64_t rootEnd) const {
    // Later versions cover other bytes. All ones in the low half: the writer stored no checksum.
    constexpr std::uint32_t kLastMinor = 4, kNoChecksum = 0xffffffffu;
    const auto stored = static_cast<std::uint32_t>(head.mChecksum);
    if (head.mVersion.getMinor() > kLastMinor || stored == kNoChecksum) return;
    constexpr std::uint64_t kStart = 16;  // behind magic number and checksum
    const auto actual =
        static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(grid_.data()) + kStart, rootEnd - kStart));
    if (actual != stored) fail(fmt::format("the checksum must be {:08x}; got {:08x}", stored, actual));
}

template <typename BuildT>
void NanoTreeReader<BuildT>::readRoot(const Root& root) {
    tree_.background = root.mBackground;
    std::uint64_t upperNodes = 0;
    const auto* tiles = reinterpret_cast<const typename Root::Tile*>(&root + 1);
    for (std::uint32_t i = 0; i < root.mTableSize; ++i) {
        const nanovdb::Coord corner = tiles[i].origin();
        const glm::i64vec3 origin(corner[0], corner[1], corner[2]);
        if (!tiles[i].isChild()) {
            addTile(origin, nanovdb::NanoUpper<BuildT>::DIM, tiles[i].value, tiles[i].state != 0);
            continue;
        }
        // Damaged offsets may share nodes; without a limit a small file could take for ever.
        if (++upperNodes > grid_.size() / sizeof(Upper)) fail("it has more nodes than bytes for them");
        readInternal(*nodeAt<Upper>(positionOf(&root), tiles[i].child), origin);
    }
}

template <typename BuildT>
template <typename Node>
void NanoTreeReader<BuildT>::readInternal(const Node& node, glm::i64vec3 origin) {
    constexpr bool kIsUpper = std::is_same_v<Node, Upper>;
    constexpr unsigned kLog2Count = kIsUpper ? 5 : 4;
    constexpr std::int64_t kChildEdge = kIsUpper ? 128 : kLeafEdge;
    for (std::uint32_t i = 0; i < 1u << (3 * kLog2Count); ++i) {
        const glm::i64vec3 position(i >> (2 * kLog2Count), i >> kLog2Count & ((1u << kLog2Count) - 1),
                                    i & ((1u << kLog2Count) - 1));
        const glm::i64vec3 childOrigin = origin + position * kChildEdge;
        if (node.mChildMask.isOn(i))
            readChild(node, node.mTable[i].child, childOrigin);
        else
            addTile(childOrigin, kChildEdge, node.mTable[i].value, node.mValueMask.isOn(i));
    }
}

template <typename BuildT>
void NanoTreeReader<BuildT>::readChild(const Upper& parent, std::int64_t offset, glm::i64vec3 origin) {
    if (++lowerNodes_ > grid_.size() / sizeof(Lower)) fail("it has more nodes than bytes for them");
    readInternal(*nodeAt<Lower>(positionOf(&parent), offset), origin);
}

template <typename BuildT>
void NanoTreeReader<BuildT>::readChild(const Lower& parent, std::int64_t offset, glm::i64vec3 origin) {
    if (leaves_.size() >= grid_.size() / sizeof(Leaf)) fail("it has more leaves than bytes for them");
    const Leaf* leaf = nodeAt<Leaf>(positionOf(&parent), offset);
    if constexpr (std::is_same_v<BuildT, nanovdb::FpN>) {
        constexpr unsigned kLargestLog2Bits = 4;
        if (leaf->mFlags >> 5 > kLargestLog2Bits) fail("a leaf must have at most 16 bits per value");
        nodeAt<Leaf>(positionOf(leaf), 0, leaf->memUsage());  // its values follow it
    }
    leaves_.push_back(leaf);
    tree_.leaves.push_back({origin, reinterpret_cast<const std::byte*>(&leaf->mValueMask)});
}

template <typename BuildT>
void NanoTreeReader<BuildT>::addTile(glm::i64vec3 origin, std::int64_t edge, float value, bool isActive) {
    if (isActive)
        tree_.activeTiles.push_back({origin, edge, value});
    else if (value != 0.0f && value != tree_.background)
        tree_.inactiveNonZero += static_cast<std::uint64_t>(edge) * edge * edge;
}

bool isSupported(nanovdb::GridType type) {
    using enum nanovdb::GridType;
    return type == Float || type == Fp4 || type == Fp8 || type == Fp16 || type == FpN;
}

std::string typeName(nanovdb::GridType type) {
    return type < nanovdb::GridType::End ? nanovdb::toStr(type) : fmt::format("type {}", std::uint32_t(type));
}

GridChoice chooseEntry(const std::vector<NvdbGridEntry>& entries, const VolumeBytes& input) {
    std::vector<NamedGrid> grids;
    for (const NvdbGridEntry& entry : entries)
        grids.push_back({entry.name, typeName(entry.type), isSupported(entry.type)});
    return chooseGrid(grids, "float, Fp4, Fp8, Fp16 or FpN", input);
}

}  // namespace

Volume readNanoVdbVolume(const VolumeBytes& input) {
    ByteReader reader(input.bytes, input.where);
    const std::vector<NvdbGridEntry> entries = readNvdbEntries(reader);
    const GridChoice choice = chooseEntry(entries, input);
    const NvdbGridEntry& entry = entries[choice.index];
    checkMemory(input.where, entry.gridBytes, input.options.memoryLimitBytes);
    const std::vector<NvdbBlock> blocks = decodeNvdbGrid(entry, input.where);
    const std::span<const std::byte> grid(reinterpret_cast<const std::byte*>(blocks.data()), entry.gridBytes);

    if (grid.size() >= sizeof(nanovdb::GridData) &&
        reinterpret_cast<const nanovdb::GridData*>(grid.data())->mGridType != entry.type)
        throw InputError(input.where, fmt::format("damaged: grid \"{}\" must have its metadata's type", entry.name));
    switch (entry.type) {
        case nanovdb::GridType::Fp4:
            return NanoTreeReader<nanovdb::Fp4>(grid, choice, input.where).read(input);
        case nanovdb::GridType::Fp8:
            return NanoTreeReader<nanovdb::Fp8>(grid, choice, input.where).read(input);
        case nanovdb::GridType::Fp16:
            return NanoTreeReader<nanovdb::Fp16>(grid, choice, input.where).read(input);
        case nanovdb::GridType::FpN:
            return NanoTreeReader<nanovdb::FpN>(grid, choice, input.where).read(input);
        default:
            return NanoTreeReader<float>(grid, choice, input.where).read(input);
    }
}

}  // namespace parhelion
