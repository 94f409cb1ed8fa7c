// Runs a function of a shader module on rows of inputs: the device's half of test::probe().
//
// A parity shader includes this, then the modules under test, and defines probeItem(): a switch over
// probeFunction that reads probeInput(0), probeInput(1), ... and calls probeOutput(0, ...), ...
// Bindings 29 to 31 and constant 255 leave those of core/scene.glsl and core/effects.glsl free. No push constants: the
// software driver would compile the shader once more for their values.
#ifndef SUPPORT_PROBE_GLSL
#define SUPPORT_PROBE_GLSL

layout(local_size_x = 64) in;

layout(set = 0, binding = 30, std430) readonly buffer ProbeInputs { vec4 probeInputs[]; };
layout(set = 0, binding = 31, std430) writeonly buffer ProbeOutputs { vec4 probeOutputs[]; };
layout(constant_id = 255) const uint probeFunction = 0u;
layout(set = 0, binding = 29, std430) readonly buffer ProbeArguments {
    uint probeCount;
    uint probeInputsPerItem;
    uint probeOutputsPerItem;
};

uint probeIndex() { return gl_GlobalInvocationID.x; }
vec4 probeInput(uint i) { return probeInputs[probeIndex() * probeInputsPerItem + i]; }
void probeOutput(uint i, vec4 value) { probeOutputs[probeIndex() * probeOutputsPerItem + i] = value; }

void probeItem();

void main() {
    if (probeIndex() < probeCount) probeItem();
}

#endif
