// Effects and quality as specialisation constants: `false` removes the code it guards.
// Shader only: the reference simulates every effect, always.
#ifndef CORE_EFFECTS_GLSL
#define CORE_EFFECTS_GLSL

#include "shared/effects.h"
#include "shared/quality.h"
#include "shared/sizes.h"

#define X(name, id, label) layout(constant_id = id) const bool name = true;
PARHELION_EFFECTS(X)
#undef X

#define X(name, id, type, value, label) layout(constant_id = id) const type name = value;
PARHELION_QUALITY(X)
#undef X

#define X(name, id) layout(constant_id = id) const uint name = 1u;
PARHELION_SIZES(X)
#undef X

#endif
