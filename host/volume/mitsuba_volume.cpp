#include <fmt/format.h>

#include "volume/byte_reader.h"
#include "volume/byte_writer.h"
#include "volume/volume_checks.h"
#include "volume/volume_formats.h"

namespace parhelion {

namespace {

constexpr std::uint8_t kVersion = 3;
constexpr std::int32_t kFloat32 = 1;

struct Header {
    glm::ivec3 resolution;
    std::int32_t channels;
    glm::vec3 boundsMin, boundsMax;
};

Header readHeader(ByteReader& reader) {
    reader.take(3, "the magic \"VOL\"");
    if (const auto version = reader.read<std::uint8_t>("the version"); version != kVersion)
        reader.fail(fmt::format("Mitsuba volume version must be {}; got {}", kVersion, version));
    if (const auto type = reader.read<std::int32_t>("the value type"); type != kFloat32)
        reader.fail(fmt::format("value type must be {} (float32); got {}", kFloat32, type));
    Header header;
    header.resolution = reader.read<glm::ivec3>("the resolution");
    header.channels = reader.read<std::int32_t>("the number of channels");
    header.boundsMin = reader.read<glm::vec3>("the bounds");
    header.boundsMax = reader.read<glm::vec3>("the bounds");
    checkResolution(reader.where(), header.resolution);
    if (header.channels != 1 && header.channels != 3)
        reader.fail(fmt::format("channels must be 1 or 3; got {}", header.channels));
    return header;
}

}  // namespace

Volume readMitsubaVolume(const VolumeBytes& input) {
    ByteReader reader(input.bytes, input.where);
    const Header header = readHeader(reader);
    const glm::uvec3 resolution = header.resolution;
    const std::uint64_t count = std::uint64_t(resolution.x) * resolution.y * resolution.z * header.channels;
    const std::span<const std::byte> data = reader.take(count * sizeof(float), "the voxel data");
    if (reader.remaining() > 0)
        reader.fail(fmt::format("the file must end after the voxels; got {} more bytes", reader.remaining()));

    Volume volume =
        volumeFromDense(input, resolution, header.channels, {reinterpret_cast<const float*>(data.data()), count});
    volume.boundsMin = header.boundsMin;
    volume.boundsMax = header.boundsMax;
    if (!areBounds(volume.boundsMin, volume.boundsMax))
        volume.note = "its bounding box is empty or not finite, which matters with \"use_grid_bbox\" only";
    return volume;
}

void writeMitsubaVolume(const std::filesystem::path& file, const Volume& volume) {
    ByteWriter writer(file);
    writer.write("VOL", 3);
    writer.write(kVersion);
    writer.write(kFloat32);
    writer.write(glm::ivec3(resolutionOf(volume)));
    writer.write(static_cast<std::int32_t>(volume.channels));
    writer.write(glm::vec3(volume.boundsMin));
    writer.write(glm::vec3(volume.boundsMax));
    const std::vector<float> values = denseValues(volume);
    writer.write(values.data(), values.size() * sizeof(float));
    writer.close();
}

}  // namespace parhelion
