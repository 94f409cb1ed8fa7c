#version 460
#include "../support/probe.glsl"
#include "sampling/warp.glsl"

void probeItem() {
    vec4 u = probeInput(0u);
    probeOutput(0u, vec4(cosineHemisphere(u.xy), 0.0));
    probeOutput(1u, vec4(uniformSphere(u.xy), 0.0));
    probeOutput(2u, vec4(uniformCone(u.xy, u.z), 0.0));
    probeOutput(3u, vec4(uniformTriangle(u.xy), 0.0));
}
