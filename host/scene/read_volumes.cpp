#include "scene/read_volumes.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/read_cloud.h"
#include "scene/transforms.h"
#include "volume/volume_checks.h"
#include "volume/volume_file.h"

namespace parhelion {
namespace {

void checkAlbedoGrid(const PropertyReader& reader, const Volume& volume) {
    float largest = volume.density.maximum();
    if (volume.channels == 3)
        largest = volume.color.values.empty() ? 0.0f : *std::ranges::max_element(volume.color.values);
    if (largest > 1.0f)
        reader.fail(reader.whereOf("filename"),
                    fmt::format("albedo must be in [0, 1] everywhere; {} has {}", volume.source, largest));
}

/// Grid-local [0, 1]^3 to the file's bounding box.
glm::dmat4 boundsTransform(const PropertyReader& reader, const Volume& volume) {
    if (!areBounds(volume.boundsMin, volume.boundsMax))
        reader.fail(reader.whereOf("use_grid_bbox"),
                    fmt::format("the bounding box of {} is empty or not finite", volume.source));
    return glm::scale(glm::translate(glm::dmat4(1.0), volume.boundsMin), volume.boundsMax - volume.boundsMin);
}

/// How Mitsuba looks values up between voxels, and outside of the grid. A medium ends with the grid of its extinction,
/// within which mirroring at the edge is the same as clamping to it: both continue the outermost voxel.
void readLookup(ReadContext& context, PropertyReader& reader, VolumeRole role) {
    const auto given = [&reader](const char* name, std::string_view value) {
        const XmlAttribute* text = reader.text(name);
        return text && text->value == value;
    };
    const auto refuse = [&reader](const char* name, std::string_view value, std::string_view reason) {
        reader.fail(reader.whereOf(name), fmt::format("\"{}\" cannot be \"{}\": {}", name, value, reason));
    };
    if (given("filter_type", "nearest"))
        refuse("filter_type", "nearest", "values are always interpolated here; allowed: trilinear");
    reader.choice("filter_type", "trilinear", {"trilinear"});
    for (const char* wrap : {"repeat", "mirror"})
        if (given("wrap_mode", wrap) && (wrap[0] == 'r' || role == VolumeRole::Albedo))
            refuse("wrap_mode", wrap, "grids are not continued outside of their box here; allowed: clamp");
    if (reader.choice("wrap_mode", "clamp", {"clamp", "mirror"}) == "mirror")
        context.note(reader.whereOf("wrap_mode"), "\"wrap_mode\" mirror has no effect: the medium ends with the grid");
}

GridPlacement readGrid(ReadContext& context, PropertyReader& reader, VolumeRole role) {
    readLookup(context, reader, role);
    // Both concern Mitsuba's spectral upsampling and texture units: they change nothing about an RGB image.
    reader.boolean("raw", false);
    reader.boolean("accel", true);
    if (reader.has("max_value")) {
        reader.number("max_value", 0.0, kNonNegative);
        context.note(reader.whereOf("max_value"), "\"max_value\" has no effect: bounds follow from the values");
    }

    GridPlacement placement;
    placement.where = reader.where();
    placement.toWorld = reader.transform("to_world").matrix;
    VolumeReadOptions options;
    options.memoryLimitBytes = context.options.volumeMemoryLimitBytes;
    if (const XmlAttribute* name = reader.text("grid_name")) options.gridName = name->value;
    options.gridNameWhere = reader.whereOf("grid_name");
    const std::filesystem::path file = reader.file("filename");
    const bool useBounds = reader.boolean("use_grid_bbox", false);
    reader.finish();

    placement.volume = readVolume(file, reader.whereOf("filename"), options);
    if (role == VolumeRole::Albedo) checkAlbedoGrid(reader, placement.volume);
    if (useBounds) placement.toWorld = placement.toWorld * boundsTransform(reader, placement.volume);
    if (!placement.volume.note.empty()) context.note(reader.whereOf("filename"), placement.volume.note);
    return placement;
}

/// A constant has its value everywhere; a heterogeneous medium ends with the cube that to_world places.
void readConstant(ReadContext& context, PropertyReader& reader, VolumeRole role, ReadVolume& result) {
    result.constant = reader.color("value", 1.0, role == VolumeRole::Albedo ? kUnitInterval : kNonNegative);
    result.extent = {reader.transform("to_world").matrix, reader.where()};
    if (reader.has("to_world") && role == VolumeRole::Albedo)
        context.note(reader.whereOf("to_world"), "\"to_world\" has no effect on a constant albedo");
    reader.finish();
}

}  // namespace

ReadVolume readVolumePlugin(ReadContext& context, const XmlElement& element, VolumeRole role) {
    context.volumesRead.insert(&element);
    PropertyReader reader(context.tree, element);
    ReadVolume result;
    if (reader.type() == "gridvolume") {
        result.grid = readGrid(context, reader, role);
    } else if (reader.type() == "constvolume") {
        readConstant(context, reader, role, result);
    } else if (reader.type() == "procedural_cloud" && role == VolumeRole::Extinction) {
        result.grid = readProceduralCloud(context, reader);
    } else if (role == VolumeRole::Extinction) {
        reader.rejectType({"gridvolume", "constvolume", "procedural_cloud"});
    } else {
        reader.rejectType({"gridvolume", "constvolume"});
    }
    return result;
}

}  // namespace parhelion
