#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compile/placed_shape.h"

namespace parhelion {

/// Which medium lies around which shape. Indices are into the placed shapes.
struct Nesting {
    /// Shapes at which a ray changes medium: null ones with a medium, and opaque ones whose medium holds the camera.
    std::vector<bool> isBoundary;
    /// The shape whose interior surrounds this one's; none for vacuum and for shapes that bound no medium.
    std::vector<std::optional<std::size_t>> surrounding;
    /// The innermost medium boundary around the camera.
    std::optional<std::size_t> camera;
};

/// Works out how the shapes that bound media lie within one another, before any is dropped.
///
/// @param media  for names in messages.
/// @throws InputError for more than kMaxBoundaries medium boundaries, for media that overlap without one lying within
/// the other, for a nested medium whose `exterior`
///         does not name the one around it, and for an `exterior` that no enclosing shape provides.
Nesting resolveNesting(std::span<const PlacedShape> shapes, std::span<const MediumDescription> media);

/// @throws InputError for a medium named by the sensor that is not the one `nesting` finds around it.
void checkCameraMedium(const SceneDescription& description, std::span<const PlacedShape> shapes,
                       const Nesting& nesting);

}  // namespace parhelion
