#version 460
#include "../support/probe.glsl"

layout(constant_id = 7) const float kScale = 1.0;
layout(set = 0, binding = 5) uniform samplerBuffer table;

void probeItem() {
    switch (probeFunction) {
        case 0u: probeOutput(0u, kScale * probeInput(0u)); break;
        case 1u:
            probeOutput(0u, probeInput(0u) + probeInput(1u));
            probeOutput(1u, vec4(probeIndex(), probeCount, texelFetch(table, 1).x, 0.0));
            break;
    }
}
