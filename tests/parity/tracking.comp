#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "volume/tracking.glsl"

Segment segmentOf(bool shadow) {
    vec4 a = probeInput(0u);  // t, end, residual, threshold or hero
    return Segment(a.x, a.y, a.z, 0u, ivec3(0), kTracking, shadow, uint(a.w), a.w, probeInput(1u).xyz, vec3(1.0));
}

void probeItem() {
    vec4 q = probeInput(2u);  // and u
    Medium medium = scene.media[0];
    Segment s = segmentOf(probeFunction == 1u || probeFunction == 2u);
    switch (probeFunction) {
        case 0u: decideFlight(s, q.xyz, q.w, q[s.hero], 1.0); break;
        case 1u: decideShadow(s, q.xyz, q.w); break;
        case 2u: stepAnalytically(s, medium); break;
        case 3u:  // cells, then the collision; the draw is named by vertex 0
            uint violations = 0u;
            vec3 origin = probeInput(1u).xyz, direction = probeInput(2u).xyz;
            s.cell = startCell(medium, origin, direction, s.t);
            GridRay ray = gridRay(medium, origin, direction, s.cell);
            for (uint i = 0u; i < 64u && s.state == kTracking && s.collisions == 0u; ++i)
                stepSegment(s, medium, ray, uvec2(1u, 2u), 0u, violations);
            break;
    }
    probeOutput(0u, vec4(s.weight, float(s.state)));
    probeOutput(1u, vec4(s.ratio, uintBitsToFloat(segmentPurpose(s))));
    probeOutput(2u, vec4(s.t, s.residual, s.collisions, 0.0));
}
