#include "volume/volume_file.h"

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "base/files.h"
#include "volume/volume_checks.h"
#include "volume/volume_formats.h"

namespace parhelion {

namespace {

struct Format {
    std::string_view magic;
    Volume (*read)(const VolumeBytes&);
    bool hasNames;  ///< of grids, any number of which a file may hold
};

constexpr std::array<Format, 4> kFormats{{
    {"VOL", readMitsubaVolume, false},
    {"PARHGRID", readGridVolume, false},
    {std::string_view(" BDV\0\0\0\0", 8), readOpenVdbVolume, true},
    {"NanoVDB", readNanoVdbVolume, true},
}};

bool startsWith(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

void writeByExtension(const std::filesystem::path& destination, const std::filesystem::path& temporary,
                      const Volume& volume, const VolumeWriteOptions& options) {
    const std::string extension = destination.extension().string();
    const bool isVdb = extension == ".vdb" || extension == ".nvdb";
    if (isVdb && volume.channels != 1)
        throw InputError({destination.string()},
                         fmt::format("{} holds one channel here, .vol and .grid hold 1 or 3; got {} channels",
                                     extension, volume.channels));
    if (extension != ".grid" && options.valueType != GridValueType::kFloat32)
        throw InputError({destination.string()}, "only .grid holds float16 or 8-bit values; got " + extension);
    if (extension == ".vol") return writeMitsubaVolume(temporary, volume);
    if (extension == ".grid") return writeGridVolume(temporary, volume, options.valueType);
    if (extension == ".vdb") return writeOpenVdbVolume(temporary, volume);
    return writeNanoVdbVolume(temporary, volume);
}

}  // namespace

Volume readVolume(const std::filesystem::path& file, const SourceLocation& where, const VolumeReadOptions& options) {
    const std::vector<std::byte> bytes = readBinaryFile(file, where);
    const SourceLocation blamed{file.string()};
    for (const Format& format : kFormats) {
        if (!startsWith(bytes, format.magic)) continue;
        if (!format.hasNames && !options.gridName.empty())
            throw InputError(options.gridNameWhere,
                             fmt::format("only .vdb and .nvdb files have named grids, {} holds a single one without a "
                                         "name; got \"{}\"",
                                         file.string(), options.gridName));
        Volume volume = format.read({bytes, blamed, options});
        volume.source = volume.source.empty() ? file.string() : fmt::format("{} ({})", file.string(), volume.source);
        return volume;
    }
    throw InputError(blamed, "not a volume file; allowed are Mitsuba .vol, .grid, OpenVDB .vdb and NanoVDB .nvdb");
}

void writeVolume(const std::filesystem::path& file, const Volume& volume, const VolumeWriteOptions& options) {
    const std::string extension = file.extension().string();
    if (extension != ".vol" && extension != ".grid" && extension != ".vdb" && extension != ".nvdb")
        throw InputError({file.string()},
                         fmt::format("extension must be .vol, .grid, .vdb or .nvdb; got \"{}\"", extension));
    checkBounds({file.string()}, volume.boundsMin, volume.boundsMax);
    AtomicFile target(file);
    writeByExtension(file, target.temporaryPath(), volume, options);
    target.commit();
}

Volume volumeFromDense(const VolumeBytes& input, glm::uvec3 resolution, unsigned channels,
                       std::span<const float> values) {
    checkValues(input.where, values, resolution, channels);
    Volume volume;
    volume.channels = channels;
    if (channels == 1) {
        const std::size_t bricks = DensityGrid::countOccupiedBricks(resolution, values);
        checkMemory(input.where, gridBytes(resolution, bricks), input.options.memoryLimitBytes);
        volume.density = DensityGrid::fromDense(resolution, values);
    } else {
        checkMemory(input.where, values.size_bytes(), input.options.memoryLimitBytes);
        volume.color = {resolution, {values.begin(), values.end()}};
    }
    return volume;
}

std::vector<float> denseValues(const Volume& volume) {
    return volume.channels == 1 ? volume.density.toDense() : volume.color.values;
}

}  // namespace parhelion
