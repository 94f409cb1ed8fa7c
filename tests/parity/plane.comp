#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "geometry/intersection.glsl"

// The plane of a face, and the distances of one of its corners and of a point.
void probeItem() {
    Face face = Face(probeInput(0u).xyz, probeInput(1u).xyz, probeInput(2u).xyz);
    vec3 point = probeInput(3u).xyz;
    Plane plane = planeOf(face);
    probeOutput(0u, vec4(plane.at, plane.spread));
    probeOutput(1u, vec4(plane.normal, dot(planeDistance(plane, face, face.b), vec2(1.0))));
    probeOutput(2u, vec4(planeDistance(plane, face, point), startDistance(plane, face, false, point)));
}
