// Density and albedo lookups. The field between voxel centres is trilinear, constant beyond the
// outermost ones. Stochastic lookups read one corner, chosen with its trilinear weight: unbiased
// wherever the value enters linearly, as it does in null-collision tracking.
#ifndef VOLUME_DENSITY_GLSL
#define VOLUME_DENSITY_GLSL

#include "core/scene.glsl"

// Voxel of a medium's grid; `voxel` is inside the resolution.
float densityVoxel(Medium medium, uvec3 voxel) {
    if (hasBrickedDensity && (medium.flags & kMediumBricked) != 0u) {
        uvec3 bricks = (medium.resolution + 7u) / 8u;
        uvec3 brick = voxel >> 3u, local = voxel & 7u;
        uint entry = texelFetch(brickTexels,
            int(medium.voxelOffset + (brick.z * bricks.y + brick.y) * bricks.x + brick.x)).x;
        uint index = (local.z * 8u + local.y) * 8u + local.x;
        float value = texelFetch(densityTexels, int(entry == kEmptyBrick ? 0u : entry + index)).x;
        return entry == kEmptyBrick ? 0.0 : value;
    }
    uint index = (voxel.z * medium.resolution.y + voxel.y) * medium.resolution.x + voxel.x;
    return texelFetch(densityTexels, int(medium.voxelOffset + index)).x;
}

// One of the eight voxels around p, chosen with its trilinear weight.
uvec3 stochasticCorner(vec3 p, uvec3 resolution, vec3 u) {
    vec3 s = p - 0.5;
    vec3 base = floor(s);
    vec3 corner = base + mix(vec3(0.0), vec3(1.0), lessThan(u, s - base));
    return uvec3(clamp(corner, vec3(0.0), vec3(resolution - 1u)));
}

// Values of a voxel of a medium with kMediumColorDensity, one a channel.
vec3 colorVoxel(Medium medium, uvec3 voxel) {
    uint index = (voxel.z * medium.resolution.y + voxel.y) * medium.resolution.x + voxel.x;
    int first = int(medium.voxelOffset + 3u * index);
    return vec3(texelFetch(densityTexels, first).x, texelFetch(densityTexels, first + 1).x,
                texelFetch(densityTexels, first + 2).x);
}

// Density of each channel in a voxel.
vec3 voxelAt(Medium medium, uvec3 voxel) {
    if (hasColorDensity && (medium.flags & kMediumColorDensity) != 0u) return colorVoxel(medium, voxel);
    return vec3(densityVoxel(medium, voxel));
}

vec3 trilinearDensity(Medium medium, vec3 pg) {
    vec3 s = pg - 0.5;
    vec3 base = floor(s);
    vec3 f = s - base;
    vec3 top = vec3(medium.resolution - 1u);
    uvec3 a = uvec3(clamp(base, vec3(0.0), top));
    uvec3 b = uvec3(clamp(base + 1.0, vec3(0.0), top));
    vec3 x00 = mix(voxelAt(medium, a), voxelAt(medium, uvec3(b.x, a.yz)), f.x);
    vec3 x10 = mix(voxelAt(medium, uvec3(a.x, b.y, a.z)), voxelAt(medium, uvec3(b.xy, a.z)), f.x);
    vec3 x01 = mix(voxelAt(medium, uvec3(a.xy, b.z)), voxelAt(medium, uvec3(b.x, a.y, b.z)), f.x);
    vec3 x11 = mix(voxelAt(medium, uvec3(a.x, b.yz)), voxelAt(medium, b), f.x);
    return mix(mix(x00, x10, f.y), mix(x01, x11, f.y), f.z);
}

// Density of each channel at pg in voxel units; `u`: three uniforms for the stochastic corner, the same for all channels.
vec3 densityAt(Medium medium, vec3 pg, vec3 u) {
    if (!stochasticFilter) return trilinearDensity(medium, pg);
    return voxelAt(medium, stochasticCorner(pg, medium.resolution, u));
}

// Single-scattering albedo at world position p: the constant, or one corner of the medium's grid.
vec3 albedoAt(Medium medium, vec3 p, vec3 u) {
    vec3 albedo = medium.albedo;
    if (hasAlbedoGrids && (medium.flags & kMediumAlbedoGrid) != 0u) {
        uvec3 voxel = stochasticCorner(medium.albedoFromWorld * vec4(p, 1.0), medium.albedoResolution, u);
        uint index = (voxel.z * medium.albedoResolution.y + voxel.y) * medium.albedoResolution.x + voxel.x;
        albedo = texelFetch(albedoTexels, int(medium.albedoOffset + index)).xyz;
    }
    return albedo;
}

#endif
