#include "scene/read_sensor.h"

#include <algorithm>
#include <cmath>

#include "scene/attribute_values.h"
#include "scene/read_film.h"
#include "scene/read_media.h"
#include "scene/transforms.h"

namespace parhelion {
namespace {

const std::vector<std::string> kFovAxes{"x", "y", "diagonal", "smaller", "larger"};  // in the order of FovAxis

double readFocalLength(const PropertyReader& reader, const XmlAttribute& value) {
    std::string text = value.value;
    if (text.ends_with("mm")) text.resize(text.size() - 2);
    const double length = numberOrNan(text);
    if (!kPositive.contains(length))
        reader.fail(value.where, fmt::format("\"focal_length\" must be a length above 0 like \"50mm\"; got \"{:.40}\"",
                                             value.value));
    return length;
}

void readFov(PropertyReader& reader, CameraDescription& camera) {
    const XmlAttribute* lens = reader.text("focal_length");
    if (!reader.has("fov")) {
        if (reader.has("fov_axis"))
            reader.fail(reader.whereOf("fov_axis"), "\"fov_axis\" needs a \"fov\"; a focal length fixes the diagonal");
        camera.fovDegrees = diagonalFovOfLens(lens ? readFocalLength(reader, *lens) : 50.0);
        camera.fovAxis = FovAxis::Diagonal;
        return;
    }
    if (lens) reader.fail(lens->where, "give either \"fov\" or \"focal_length\", not both");
    camera.fovDegrees = reader.number("fov", 0.0, kFovRange);
    const std::string axis = reader.choiceInAnyCase("fov_axis", "x", kFovAxes);
    camera.fovAxis = static_cast<FovAxis>(std::ranges::find(kFovAxes, axis) - kFovAxes.begin());
}

/// Accepts Mitsuba's shutter times: nothing moves here, as nothing does there.
void readShutter(ReadContext& context, PropertyReader& reader) {
    const double open = reader.number("shutter_open", 0.0), close = reader.number("shutter_close", 0.0);
    if (open > close)
        reader.fail(reader.whereOf("shutter_open"),
                    fmt::format("\"shutter_open\" must be at most \"shutter_close\"; got {} and {}", open, close));
    for (const char* name : {"shutter_open", "shutter_close"})
        if (reader.has(name))
            context.note(reader.whereOf(name), fmt::format("\"{}\" has no effect: nothing moves", name));
}

/// Accepts the distance that a lens would be focused at, and refuses a film that is not sensitive to red, green, blue.
void readOptics(ReadContext& context, PropertyReader& reader) {
    reader.number("focus_distance", 0.0);
    if (reader.has("focus_distance"))
        context.note(reader.whereOf("focus_distance"),
                     "\"focus_distance\" has no effect: a pinhole camera is sharp at every distance");
    if (reader.has("srf"))
        reader.fail(reader.whereOf("srf"),
                    "\"srf\", a spectral response, needs a spectral renderer; this one renders red, green and blue, "
                    "where Mitsuba refuses it too");
}

void readSampler(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    const std::vector<std::string> supported{"independent", "stratified", "multijitter", "orthogonal", "ldsampler"};
    if (std::ranges::find(supported, reader.type()) == supported.end()) reader.rejectType(supported);
    context.scene.sampleCount = static_cast<std::uint64_t>(reader.integer("sample_count", 4, 1, kMostSamples));
    context.scene.seed = static_cast<std::uint32_t>(reader.integer("seed", 0, 0, 0xffffffffLL));
    if (reader.type() != "independent") {
        context.note(reader.where(), fmt::format("sampler \"{}\": our own sampler is used; the number of samples is "
                                                 "taken as it is",
                                                 reader.type()));
        reader.boolean("jitter", true);
        if (reader.type() == "orthogonal") reader.integer("strength", 2, 1, 16);
    }
    reader.finish();
}

}  // namespace

double diagonalFovOfLens(double focalLength) {
    return glm::degrees(2.0 * std::atan(std::hypot(36.0, 24.0) / (2.0 * focalLength)));
}

glm::dmat4 readCameraTransform(PropertyReader& reader, const char* name) {
    const PropertyReader::Transform toWorld = reader.transform(name);
    const Similarity similarity = similarityOf(toWorld.matrix);
    constexpr double kScaleTolerance = 1e-3;  // Mitsuba's
    if (!similarity.holds || std::abs(similarity.scale - 1.0) > kScaleTolerance)
        reader.fail(toWorld.where, fmt::format("\"{}\" of a camera must not scale or shear", name));
    return toWorld.matrix;
}

void readClipping(ReadContext& context, PropertyReader& reader, const char* nearName, const char* farName) {
    const double nearClip = reader.number(nearName, 1e-2, kPositive);
    const double farClip = reader.number(farName, 1e4, kPositive);
    if (nearClip >= farClip)
        reader.fail(
            reader.whereOf(reader.has(nearName) ? nearName : farName),
            fmt::format("\"{}\" must be less than \"{}\"; got {} and {}", nearName, farName, nearClip, farClip));
    for (const char* name : {nearName, farName})
        if (reader.has(name))
            context.note(reader.whereOf(name), fmt::format("\"{}\" has no effect: rays start at the camera and have no "
                                                           "end, so that nothing is cut off",
                                                           name));
}

void readSensor(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "perspective") reader.rejectType({"perspective"});
    if (const auto film = reader.onlyNested("film")) readFilm(context, *film->element);
    if (const auto sampler = reader.onlyNested("sampler")) readSampler(context, *sampler->element);

    CameraDescription& camera = context.scene.camera;
    if (const auto medium = reader.onlyNested("medium")) {
        camera.medium = mediumIndex(context, *medium->element);
        camera.mediumWhere = medium->where;
    }
    camera.where = reader.where();
    camera.toWorld = readCameraTransform(reader, "to_world");
    readFov(reader, camera);
    for (int axis = 0; axis < 2; ++axis)
        camera.principalPointOffset[axis] =
            reader.number(axis == 0 ? "principal_point_offset_x" : "principal_point_offset_y", 0.0, kAnyNumber);
    readClipping(context, reader, "near_clip", "far_clip");
    readShutter(context, reader);
    readOptics(context, reader);
    reader.finish();
}

}  // namespace parhelion
