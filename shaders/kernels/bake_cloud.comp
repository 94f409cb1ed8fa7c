// A lane a voxel: the density of a procedural cloud at the voxel's centre.
// `modulates` of the arguments is a specialisation constant here: the driver skips no branch.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;

#include "volume/procedural_cloud.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer BaseBlock { float base[]; };
layout(set = 0, binding = 1, scalar) writeonly buffer DensityBlock { float density[]; };
layout(set = 0, binding = 2, scalar) readonly buffer ArgumentBlock { CloudArguments submitted; };
layout(constant_id = 128) const bool modulates = false;  // clear of effects and quality

void main() {
    uint lane = gl_GlobalInvocationID.x;
    CloudArguments cloud = submitted;
    if (lane >= cloud.voxelCount) return;
    cloud.modulates = modulates ? 1u : 0u;
    uint voxel = cloud.firstVoxel + lane;
    uint row = voxel / cloud.resolution.x;
    uvec3 index = uvec3(voxel % cloud.resolution.x, row % cloud.resolution.y, row / cloud.resolution.y);
    precise vec3 p = (vec3(index) + 0.5) * cloud.voxelSize;
    density[lane] = cloudDensity(cloud, p, modulates ? base[lane] : 0.0);
}
