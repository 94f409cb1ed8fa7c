#pragma once

#include <glm/glm.hpp>

#include "scene/xml_document.h"

namespace parhelion {

/// Counter-clockwise rotation seen against `axis`, which need not be of unit length but must not be zero.
glm::dmat4 rotationMatrix(glm::dvec3 axis, double angleDegrees);

/// Camera to world: local +z towards `target`, local +y on the side of `up`, local +x = up x direction (to the left in
/// the image). Nothing is checked: coinciding points or a parallel `up` give NaN.
glm::dmat4 lookAtMatrix(glm::dvec3 origin, glm::dvec3 target, glm::dvec3 up);

/// The `up` of a <lookat> without one, as in Mitsuba: perpendicular to `direction`, which has length 1.
///
/// Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
glm::dvec3 anyUp(glm::dvec3 direction);

/// The product of a <transform>'s steps; each is applied after those above it.
/// @throws InputError at a step that is degenerate, at a matrix whose last row is not 0 0 0 1, and at the whole if it
/// cannot be inverted.
glm::dmat4 readTransform(const XmlElement& transform);

/// The same without the last condition: for texture coordinates, which may be flattened.
glm::dmat4 readFlatTransform(const XmlElement& transform);

/// Whether a linear map keeps angles (rotation, mirroring and uniform scale), to a relative 1e-4; and its scale.
struct Similarity {
    bool holds;
    double scale;
};
Similarity similarityOf(const glm::dmat4& matrix);

}  // namespace parhelion
