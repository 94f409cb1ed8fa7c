// What a dispatch counts, in 64 bits: a large device takes more than 2^32 steps in one.
// Shader only: the reference counts in 64 bits as it is.
#ifndef INTEGRATOR_COUNTERS_GLSL
#define INTEGRATOR_COUNTERS_GLSL

#include "shared/path_types.h"

layout(set = 0, binding = 14, scalar) buffer CounterBlock { uint counters[]; };  // kCounterCount low words, then the high ones

// Shader only: adds a lane's share to a counter, one atomic a subgroup. A subgroup's shares add up to less than 2^32.
void count(uint counter, uint value) {
    uint sum = subgroupAdd(value);
    if (subgroupElect() && sum > 0u) {
        uint before = atomicAdd(counters[counter], sum);
        if (before + sum < before) atomicAdd(counters[kCounterCount + counter], 1u);
    }
}

#endif
