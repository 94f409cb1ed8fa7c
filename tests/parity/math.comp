#version 460
#include "../support/probe.glsl"
#include "core/math.glsl"

void probeItem() {
    vec4 x = probeInput(0u);
    switch (probeFunction) {
        case 0u: probeOutput(0u, vec4(safeDivide(x.x, x.y), maxComponent(x.xyz), 0.0, 0.0)); break;
        case 1u: probeOutput(0u, vec4(logPositive(x.x), log(x.x), 0.0, 0.0)); break;
        case 2u: probeOutput(0u, vec4(expNegative(x.x), exp(x.x), 0.0, 0.0)); break;
        case 3u: probeOutput(0u, vec4(sinCosTurn(x.x), 0.0, 0.0)); break;
        case 5u: probeOutput(0u, vec4(angleOf(x.y, x.x), atan(x.y, x.x), 0.0, 0.0)); break;
        case 4u: probeOutput(0u, vec4(roundedSqrt(x.x), roundSqrtStep(x.x, x.y), sqrt(x.x), 0.0)); break;
    }
}
