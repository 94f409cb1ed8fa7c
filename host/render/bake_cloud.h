#pragma once

#include <span>
#include <vector>

#include "gpu/device.h"
#include "shared/cloud_types.h"

namespace parhelion::render {

/// What the bake kernel is told of a field.
/// @param largest  of the density that is modulated; 0 without.
shared::CloudArguments cloudArguments(const shared::CloudField& field, float largest);

/// The field at the centres of field.resolution voxels, x fastest, baked on a device a slab at a time.
///
/// @param base     the density to modulate, as many voxels; empty unless field.modulates.
/// @param largest  its largest value.
/// @throws RuntimeFailure for a failing device.
std::vector<float> bakeCloud(gpu::Device& device, const shared::CloudField& field, std::span<const float> base,
                             float largest);

}  // namespace parhelion::render
