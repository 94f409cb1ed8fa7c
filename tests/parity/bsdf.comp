#version 460
#include "../support/probe.glsl"
#include "surface/bsdf.glsl"

void probeItem() {
    vec3 normal = probeInput(0u).xyz, wi = probeInput(1u).xyz;
    vec2 u = probeInput(2u).xy;
    vec3 local = sampleDiffuse(u);
    probeOutput(0u, vec4(normalize(toWorld(frameFromNormal(normal), local)), pdfDiffuse(local.z)));
    probeOutput(1u, vec4(evalDiffuse(normal, wi), pdfDiffuse(dot(normal, wi)), 0.0, 0.0));
}
