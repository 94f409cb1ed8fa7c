#include "compile/compile_film.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "compile/transforms.h"

namespace parhelion {

namespace {

constexpr unsigned kMaxFilmSize = 65536;
constexpr double kMaxFilterRadius = 1024.0;

/// Blames the command line when the value came from there.
InputError filmError(const SceneDescription& description, bool fromOptions, const std::string& message) {
    return fromOptions ? InputError(message) : InputError(SourceLocation{description.file.string()}, message);
}

/// Mitsuba refuses the same: scale in the camera transform would distort the field of view.
void requireRigid(const CameraDescription& camera) {
    requireInvertible(camera.toWorld, camera.where, "sensor");
    const glm::dmat3 m(camera.toWorld);
    const glm::dmat3 gram = glm::transpose(m) * m;
    constexpr double kTolerance = 1e-3;  // Mitsuba's
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(gram[i][j] - (i == j ? 1.0 : 0.0)) > kTolerance)
                throw InputError(camera.where,
                                 "sensor: to_world must be a rotation and a translation, without scale "
                                 "or shear");
}

}  // namespace

double horizontalFov(double fovDegrees, FovAxis axis, double aspect) {
    const double tangent = std::tan(glm::radians(fovDegrees) / 2.0);
    const auto fromTangent = [](double t) { return glm::degrees(2.0 * std::atan(t)); };
    switch (axis) {
        case FovAxis::X:
            return fovDegrees;
        case FovAxis::Y:
            return fromTangent(tangent * aspect);
        case FovAxis::Diagonal:
            return fromTangent(tangent / std::sqrt(1.0 + 1.0 / (aspect * aspect)));
        case FovAxis::Smaller:
            return horizontalFov(fovDegrees, aspect > 1.0 ? FovAxis::Y : FovAxis::X, aspect);
        case FovAxis::Larger:
            return horizontalFov(fovDegrees, aspect > 1.0 ? FovAxis::X : FovAxis::Y, aspect);
    }
    return fovDegrees;
}

void compileFilm(const SceneDescription& description, const CompileOptions& options, CompiledScene& scene) {
    const FilmDescription& film = description.film;
    const glm::uvec2 size = options.size.value_or(film.size);
    for (int axis = 0; axis < 2; ++axis)
        if (size[axis] < 1 || size[axis] > kMaxFilmSize)
            throw filmError(
                description, options.size.has_value(),
                fmt::format("film: width and height must be in [1, {}]; got {} x {}", kMaxFilmSize, size.x, size.y));

    const bool fromOptions = options.size || options.cropOffset || options.cropSize;
    const glm::uvec2 offset = options.cropOffset.value_or(film.cropOffset.value_or(glm::uvec2(0)));
    const std::optional<glm::uvec2> given = options.cropSize ? options.cropSize : film.cropSize;
    const glm::uvec2 crop = given.value_or(size - glm::min(offset, size));
    for (int axis = 0; axis < 2; ++axis)
        if (crop[axis] < 1 || std::uint64_t(offset[axis]) + crop[axis] > size[axis])
            throw filmError(description, fromOptions,
                            fmt::format("film: the crop must hold at least one pixel and lie inside the film of {} x "
                                        "{}; got {} x {} at ({}, {})",
                                        size.x, size.y, crop.x, crop.y, offset.x, offset.y));
    const double radius = film.filterRadius;
    if (!(radius > 0.0 && radius <= kMaxFilterRadius))
        throw filmError(description, false,
                        fmt::format("film: the reconstruction filter's radius must be in (0, {}] "
                                    "pixels; got {}",
                                    kMaxFilterRadius, radius));
    scene.filmSize = size;
    scene.cropOffset = offset;
    scene.cropSize = crop;
    // The scene's own crop is a film of its own, as in Mitsuba; one asked for shows a part of the same picture.
    shared::Camera& camera = scene.constants.camera;
    camera.filmLower = fromOptions ? glm::uvec2(0) : offset;
    camera.filmUpper = fromOptions ? size : offset + crop;
}

void compileCamera(const SceneDescription& description, CompiledScene& scene) {
    const CameraDescription& camera = description.camera;
    requireRigid(camera);
    if (!(camera.fovDegrees > 0.0 && camera.fovDegrees < 180.0))
        throw InputError(camera.where,
                         fmt::format("sensor: fov must be in (0, 180) degrees; got {}", camera.fovDegrees));

    const glm::dmat3 toWorld(camera.toWorld);
    const glm::dvec2 size(scene.filmSize);
    const double fovX = horizontalFov(camera.fovDegrees, camera.fovAxis, size.x / size.y);
    const double halfWidth = std::tan(fovX * std::numbers::pi / 360.0);
    const double halfHeight = halfWidth * size.y / size.x;
    const glm::dvec2 corner = 1.0 - 2.0 * camera.principalPointOffset;
    const glm::dvec3 forward(corner.x * halfWidth, corner.y * halfHeight, 1.0);

    shared::Camera& record = scene.constants.camera;
    record.forward = toFloat(toWorld * forward, camera.where, "sensor: film corner");
    record.dx = toFloat(toWorld[0] * (-2.0 * halfWidth / size.x), camera.where, "sensor: pixel width");
    record.dy = toFloat(toWorld[1] * (-2.0 * halfHeight / size.y), camera.where, "sensor: pixel height");
    record.inside = shared::kNone;
    scene.worldOrigin = glm::dvec3(camera.toWorld[3]);
    scene.filterTable = reconstructionTable(description.film);
    record.hasFilter = scene.filterTable.empty() ? 0u : 1u;
    record.filterEdges = record.hasFilter ? std::uint32_t(scene.filterTable.size()) - shared::kFilterSteps - 1u : 0u;
}

}  // namespace parhelion
