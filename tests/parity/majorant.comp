#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "volume/majorant.glsl"

void probeItem() {
    Medium medium = scene.media[0];
    vec3 origin = probeInput(0u).xyz, direction = probeInput(1u).xyz;
    ivec3 cell = startCell(medium, origin, direction, probeInput(0u).w);
    GridRay ray = gridRay(medium, origin, direction, cell);
    vec3 planes = planeDistances(ray, cell);
    probeOutput(0u, vec4(ray.origin, majorantAt(medium, cell)));
    probeOutput(1u, vec4(ray.direction, 0.0));
    probeOutput(2u, vec4(cell, 0.0));
    probeOutput(3u, vec4(planes, 0.0));
    probeOutput(5u, vec4(gridInterval(medium, origin, direction), 0.0, 0.0));
    bool goesOn = min(planes.x, min(planes.y, planes.z)) < kInfinity;
    probeOutput(4u, vec4(goesOn ? nextCell(ray, cell, planes) : cell, 0.0));
}
