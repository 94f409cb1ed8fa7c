#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shared/cloud_types.h"

namespace parhelion::reference {

/// The field at the centres of field.resolution voxels, x fastest, on the CPU in Real = float or double.
/// In float the bits are the device's.
///
/// @param base     the density to modulate, as many voxels; empty unless field.modulates.
/// @param largest  its largest value.
template <typename Real>
std::vector<float> bakeCloud(const shared::CloudField& field, std::span<const float> base, float largest);

extern template std::vector<float> bakeCloud<float>(const shared::CloudField&, std::span<const float>, float);
extern template std::vector<float> bakeCloud<double>(const shared::CloudField&, std::span<const float>, float);

/// The field itself, not baked, in double precision.
/// @param p     in the unit cube.
/// @param base  the density at p that it modulates, if it does.
double cloudDensityAt(const shared::CloudField& field, const glm::dvec3& p, double base, float largest);

}  // namespace parhelion::reference
