// Words of the buffer that keeps paths between dispatches.
// Shader only: the reference never suspends a path.
#ifndef INTEGRATOR_STATE_WORDS_GLSL
#define INTEGRATOR_STATE_WORDS_GLSL

layout(set = 0, binding = 13, scalar) buffer PathStates { uint pathStates[]; };

void storeWord(inout uint at, uint stride, uint word) {
    pathStates[at] = word;
    at += stride;
}

void storeVector(inout uint at, uint stride, vec3 v) {
    uvec3 words = floatBitsToUint(v);
    storeWord(at, stride, words.x);
    storeWord(at, stride, words.y);
    storeWord(at, stride, words.z);
}

uint loadWord(inout uint at, uint stride) {
    uint word = pathStates[at];
    at += stride;
    return word;
}

float loadFloat(inout uint at, uint stride) { return uintBitsToFloat(loadWord(at, stride)); }

vec3 loadVector(inout uint at, uint stride) {
    float x = loadFloat(at, stride), y = loadFloat(at, stride), z = loadFloat(at, stride);
    return vec3(x, y, z);
}

#endif
