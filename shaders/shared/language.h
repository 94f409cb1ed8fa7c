// What C++ (GLM) and GLSL must each say for one struct or enum to mean the same in both.
#ifndef PARHELION_SHARED_LANGUAGE_H
#define PARHELION_SHARED_LANGUAGE_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

#define SHARED_BEGIN namespace parhelion::shared {
#define SHARED_END }
#define SHARED_CONST(type, name, value) inline constexpr type name = value
// The struct has the same size and tight packing as GLSL's scalar layout.
#define SHARED_LAYOUT(type, bytes) static_assert(sizeof(type) == (bytes), #type " must be tightly packed")

namespace parhelion::shared {
using uint = std::uint32_t;
using glm::ivec3;
using glm::ivec4;
using glm::mat4x3;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
}  // namespace parhelion::shared
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_CONST(type, name, value) const type name = value
#define SHARED_LAYOUT(type, bytes)
#endif

#endif
