#include "compile/medium_extent.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "compile/transforms.h"

namespace parhelion {

namespace {

std::string nameOf(const MediumDescription& medium) {
    return medium.id.empty() ? std::string("medium") : fmt::format("medium \"{}\"", medium.id);
}

std::string noteOf(const MediumDescription& medium, const std::string& text) {
    return fmt::format("{}: {}: {}", medium.where.text(), nameOf(medium), text);
}

std::string textOf(const glm::dvec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }

/// Within the unit cube under `toWorld`; what sticks out by less than 1e-6 of its edges touches it.
bool liesWithin(const PlacedShape& shape, const glm::dmat4& toWorld, const glm::dvec3& worldOrigin) {
    constexpr double kTolerance = 1e-6;
    const glm::dmat4 localFromScene = glm::inverse(relativeTo(toWorld, worldOrigin));
    const auto holds = [&](const glm::dvec3& point, const glm::dvec3& margin) {
        const glm::dvec3 local(localFromScene * glm::dvec4(point, 1.0));
        return glm::all(glm::greaterThanEqual(local - margin, glm::dvec3(-kTolerance))) &&
               glm::all(glm::lessThanEqual(local + margin, glm::dvec3(1.0 + kTolerance)));
    };
    if (shape.kind != PlacedShape::Kind::Sphere)
        return std::ranges::all_of(shape.vertices, [&](const glm::dvec3& v) { return holds(v, glm::dvec3(0.0)); });
    const glm::dmat3 rows = glm::transpose(glm::dmat3(localFromScene));
    return holds(shape.center,
                 shape.radius * glm::dvec3(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])));
}

bool lieWithin(std::span<const PlacedShape* const> shapes, const glm::dmat4& toWorld, const glm::dvec3& worldOrigin) {
    return std::ranges::all_of(shapes, [&](const PlacedShape* s) { return liesWithin(*s, toWorld, worldOrigin); });
}

/// The world-aligned box around the unit cube under `toWorld`, as a placement of that cube.
glm::dmat4 alignedBounds(const glm::dmat4& toWorld) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(toWorld * glm::dvec4(corner & 1, corner >> 1 & 1, corner >> 2 & 1, 1.0));
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    return glm::scale(glm::translate(glm::dmat4(1.0), lower), upper - lower);
}

bool isAligned(const glm::dmat4& toWorld) {
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 edge = glm::abs(glm::dvec3(toWorld[axis]));
        if (edge.x + edge.y + edge.z > (1.0 + 1e-9) * std::max({edge.x, edge.y, edge.z})) return false;
    }
    return true;
}

float valueAt(const Volume& volume, const glm::uvec3& voxel) {
    if (volume.channels == 1) return volume.density.at(voxel);
    const glm::uvec3 n = volume.color.resolution;
    const float* rgb = &volume.color.values[3 * ((std::size_t(voxel.z) * n.y + voxel.y) * n.x + voxel.x)];
    return std::max({rgb[0], rgb[1], rgb[2]});
}

/// Whether a grid holds anything in the voxels at its sides.
bool reachesItsSides(const Volume& volume) {
    const glm::uvec3 n = volume.channels == 1 ? volume.density.resolution() : volume.color.resolution;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (unsigned side = 0; side < n[axis]; side += std::max(1u, n[axis] - 1))
            for (unsigned j = 0; j < n[v]; ++j)
                for (unsigned i = 0; i < n[u]; ++i) {
                    glm::uvec3 voxel;
                    voxel[axis] = side;
                    voxel[u] = i;
                    voxel[v] = j;
                    if (valueAt(volume, voxel) > 0.0f) return true;
                }
    }
    return false;
}

/// Mitsuba goes on with the values at a grid's sides up to the world-aligned bounds of a turned grid; here it ends at
/// its own sides. The two differ where there is something at the sides and the boundary leaves room for it.
void noteTurnedGrid(const MediumDescription& medium, std::span<const PlacedShape* const> boundaries,
                    const glm::dvec3& worldOrigin, std::vector<std::string>& notes) {
    const GridPlacement& grid = *medium.density;
    if (isAligned(grid.toWorld) || lieWithin(boundaries, grid.toWorld, worldOrigin) || !reachesItsSides(grid.volume))
        return;
    notes.push_back(noteOf(medium,
                           "its density ends at the sides of its turned grid, where it is not zero; Mitsuba goes on "
                           "with the values there up to the grid's world-aligned bounds"));
}

}  // namespace

std::optional<MediumDescription> clipToExtent(const MediumDescription& medium,
                                              std::span<const PlacedShape* const> boundaries,
                                              const glm::dvec3& worldOrigin, std::vector<std::string>& notes) {
    if (medium.density) {
        requireInvertible(medium.density->toWorld, medium.density->where, nameOf(medium) + ": sigma_t");
        noteTurnedGrid(medium, boundaries, worldOrigin, notes);
    }
    if (!medium.extent) return std::nullopt;
    requireInvertible(medium.extent->toWorld, medium.extent->where, nameOf(medium) + ": sigma_t");
    const glm::dmat4 bounds = alignedBounds(medium.extent->toWorld);
    if (lieWithin(boundaries, bounds, worldOrigin)) return std::nullopt;
    const glm::dvec3 lower(bounds[3]), upper = lower + glm::dvec3(bounds[0][0], bounds[1][1], bounds[2][2]);
    notes.push_back(noteOf(
        medium, fmt::format("heterogeneous with a constant sigma_t, it fills its boundary from {} to {} only, as in "
                            "Mitsuba: the unit cube, which the to_world of a constvolume places (type \"homogeneous\" "
                            "fills all of it)",
                            textOf(lower), textOf(upper))));
    MediumDescription clipped = medium;
    GridPlacement& grid = clipped.density.emplace();
    grid.volume.density = DensityGrid::fromDense(glm::uvec3(1), std::vector<float>{1.0f});
    grid.toWorld = bounds;
    grid.where = medium.extent->where;
    return clipped;
}

}  // namespace parhelion
