#include "volume/vdb_header.h"

#include <fmt/format.h>

#include <array>
#include <functional>

namespace parhelion {

namespace {

// Layout of files: OpenVDB 10, openvdb/io/{Archive,File,GridDescriptor}.cc, math/Maps.h, MetaMap.cc.
constexpr std::uint32_t kOldestVersion = 222;  // OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION
constexpr std::uint32_t kNewestVersion = 224;  // OPENVDB_FILE_VERSION_MULTIPASS_IO
constexpr std::string_view kHalfSuffix = "_HalfFloat";
constexpr char kNameSeparator = '\x1e';  // "density\x1e1" is the second grid named "density"
constexpr std::uint32_t kLongestName = 1 << 20;

std::string readString(ByteReader& reader, std::string_view what) {
    const auto length = reader.read<std::uint32_t>(what);
    if (length > kLongestName)
        reader.fail(fmt::format("damaged: {} must have at most {} bytes; got {}", what, kLongestName, length));
    const auto bytes = reader.take(length, what);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

using VisitMetadata = std::function<void(std::string_view name, std::span<const std::byte> value)>;

void readMetadata(ByteReader& reader, const VisitMetadata& visit) {
    const auto count = reader.read<std::uint32_t>("the metadata count");
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = readString(reader, "a metadata name");
        readString(reader, "a metadata type");
        const auto size = reader.read<std::uint32_t>("a metadata size");
        visit(name, reader.take(size, "a metadata value"));
    }
}

VdbGridEntry readDescriptor(ByteReader& reader, std::uint64_t fileSize) {
    VdbGridEntry entry;
    entry.name = readString(reader, "a grid name");
    if (const std::size_t separator = entry.name.find(kNameSeparator); separator != std::string::npos) {
        entry.number = entry.name.substr(separator + 1);
        entry.name.resize(separator);
    }
    entry.type = readString(reader, "a grid type");
    if (entry.type.ends_with(kHalfSuffix)) {
        entry.isHalf = true;
        entry.type.resize(entry.type.size() - kHalfSuffix.size());
    }
    entry.isInstance = !readString(reader, "a grid's parent").empty();
    entry.begin = reader.read<std::uint64_t>("a grid position");
    const auto blocks = reader.read<std::uint64_t>("a grid position");
    entry.end = reader.read<std::uint64_t>("a grid position");
    if (entry.begin != reader.offset() || blocks < entry.begin || entry.end < blocks || entry.end > fileSize)
        reader.fail(fmt::format("truncated or damaged: grid \"{}\" must lie between bytes {} and {}; got {} to {}",
                                entry.name, reader.offset(), fileSize, entry.begin, entry.end));
    return entry;
}

GridTransform readTransform(ByteReader& reader) {
    const std::string type = readString(reader, "the transform's type");
    const bool isTranslation = type == "TranslationMap";
    const bool hasTranslation = type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap" || isTranslation;
    const bool hasScale = type == "ScaleMap" || type == "UniformScaleMap" || (hasTranslation && !isTranslation);
    if (!hasScale && !isTranslation && type != "AffineMap")
        reader.fail(fmt::format("the grid's transform must be a scale and a translation; got \"{}\"", type));

    std::array<double, 9> linear{1, 0, 0, 0, 1, 0, 0, 0, 1};
    glm::dvec3 translation(0.0);
    if (hasTranslation) translation = reader.read<glm::dvec3>("the transform's translation");
    if (hasScale) {
        for (int axis = 0; axis < 3; ++axis) linear[4 * axis] = reader.read<double>("the transform's scale");
        reader.take(4 * sizeof(glm::dvec3), "the transform's derived scales");
    } else if (!isTranslation) {
        const auto m = reader.read<std::array<double, 16>>("the transform's matrix");  // acts on row vectors
        for (int i = 0; i < 9; ++i) linear[i] = m[i / 3 * 4 + i % 3];
        translation = {m[12], m[13], m[14]};
    }
    return makeGridTransform(reader.where(), linear, translation);
}

}  // namespace

std::vector<VdbGridEntry> readVdbHeader(ByteReader& reader) {
    const std::uint64_t fileSize = reader.remaining();
    reader.take(8, "the magic number");
    if (const auto version = reader.read<std::uint32_t>("the version");
        version < kOldestVersion || version > kNewestVersion)
        reader.fail(
            fmt::format("OpenVDB file version must be {} to {}; got {}", kOldestVersion, kNewestVersion, version));
    reader.take(8, "the library version");
    if (const auto hasOffsets = reader.read<std::uint8_t>("the offset flag"); hasOffsets != 1)
        reader.fail(fmt::format("the file must have grid offsets (written by io::File); got flag {}", hasOffsets));
    reader.take(36, "the file's identifier");
    readMetadata(reader, [](std::string_view, std::span<const std::byte>) {});

    const auto count = reader.read<std::uint32_t>("the number of grids");
    std::vector<VdbGridEntry> entries;
    for (std::uint32_t i = 0; i < count; ++i) {
        entries.push_back(readDescriptor(reader, fileSize));
        reader.take(entries.back().end - reader.offset(), "a grid");
    }
    if (reader.remaining() > 0)
        reader.fail(fmt::format("damaged: the file must end after its grids; got {} more bytes", reader.remaining()));
    return entries;
}

VdbGridHead readVdbGridHead(ByteReader& reader, const VdbGridEntry& entry) {
    enum : std::uint32_t { kZip = 1, kActiveMask = 2, kBlosc = 4 };
    const auto flags = reader.read<std::uint32_t>("the compression flags");
    if (flags > (kZip | kActiveMask | kBlosc))
        reader.fail(fmt::format("compression must combine zip 1, active mask 2, blosc 4; got {}", flags));
    VdbGridHead head;
    head.isBlosc = (flags & kBlosc) != 0;
    head.isZip = !head.isBlosc && (flags & kZip) != 0;  // OpenVDB gives blosc precedence
    head.isMaskCompressed = (flags & kActiveMask) != 0;
    head.isHalf = entry.isHalf;
    readMetadata(reader, [&](std::string_view name, std::span<const std::byte> value) {
        if (name == "is_saved_as_half_float" && value.size() == 1) head.isHalf = value[0] != std::byte{0};
    });
    head.transform = readTransform(reader);
    return head;
}

}  // namespace parhelion
