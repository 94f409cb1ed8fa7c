// Loops over the scene's few analytic shapes, written out, since the driver unrolls none: `near(i)` for
// the first kNearCount, `far(i)` for the others. `count` is a specialisation constant: what lies
// beyond it folds away.
// Shader only: a C++ compiler unrolls by itself.
#ifndef CORE_UNROLL_GLSL
#define CORE_UNROLL_GLSL

const uint kNearCount = 8u;

#define FOR_EACH_NEAR(count, near) \
    if (count > 0u) { near(0u) }   \
    if (count > 1u) { near(1u) }   \
    if (count > 2u) { near(2u) }   \
    if (count > 3u) { near(3u) }   \
    if (count > 4u) { near(4u) }   \
    if (count > 5u) { near(5u) }   \
    if (count > 6u) { near(6u) }   \
    if (count > 7u) { near(7u) }

#define FOR_EACH(count, near, far)                             \
    FOR_EACH_NEAR(count, near)                                 \
    if (count > kNearCount) {                                  \
        for (uint i = kNearCount; i < count; ++i) { far(i) }   \
    }

#endif
