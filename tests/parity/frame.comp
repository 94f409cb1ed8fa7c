#version 460
#include "../support/probe.glsl"
#include "core/frame.glsl"

void probeItem() {
    Frame frame = frameFromNormal(probeInput(0u).xyz);
    probeOutput(0u, vec4(frame.tangent, 0.0));
    probeOutput(1u, vec4(frame.bitangent, 0.0));
    probeOutput(2u, vec4(toWorld(frame, probeInput(1u).xyz), 0.0));
}
