#version 460
#extension GL_EXT_scalar_block_layout : require
#include "../support/probe.glsl"
#include "integrator/camera.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u);
    probeOutput(0u, vec4(filmPosition(uvec2(a.xy), a.zw), filterOffset(a.z), filterShare(uint(a.x))));
    probeOutput(1u, vec4(cameraDirection(a.xy + a.zw), 0.0));
}
