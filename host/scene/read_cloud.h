#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// What a dialect calls the parameters of a procedural cloud.
struct CloudNames {
    const char *detailAmount, *noiseScale, *warpAmount, *erosionAmount, *surfaceWidth, *noiseSeed;
    const char *densityScale, *densityThreshold, *bakeResolution;
};

/// Reads a cloud that is a density of its own. Both dialects read clouds here, so that they share every limit.
/// @throws InputError at the value if one is out of range.
shared::CloudField readCloud(PropertyReader& reader, const CloudNames& names);

/// Reads the detail that erodes a density of `resolution` voxels; at that resolution, unless told how many voxels the
/// longest axis has.
/// @throws InputError as readCloud.
shared::CloudField readCloudModulation(PropertyReader& reader, const CloudNames& names, glm::uvec3 resolution);

/// Reads <volume type="procedural_cloud">, with the density that it modulates if one is nested. Not baked yet.
GridPlacement readProceduralCloud(ReadContext& context, PropertyReader& reader);

}  // namespace parhelion
