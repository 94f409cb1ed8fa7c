#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace parhelion::test {

/// Fixed-seed random inputs.
class Stress {
public:
    explicit Stress(std::uint32_t seed) : engine_(seed) {}

    std::uint32_t word() { return engine_(); }
    /// Uniform in [low, high).
    float between(float low, float high) { return low + (high - low) * (float(engine_() >> 8) * 0x1p-24f); }
    /// Size uniform in its logarithm, in [low, high).
    float magnitude(float low, float high) { return std::exp2(between(std::log2(low), std::log2(high))); }
    glm::vec3 point(float extent) {
        return {between(-extent, extent), between(-extent, extent), between(-extent, extent)};
    }
    glm::vec3 direction() {
        glm::vec3 v;
        do v = point(1);
        while (glm::dot(v, v) > 1 || glm::dot(v, v) < 1e-4f);
        return glm::normalize(v);
    }

private:
    std::mt19937 engine_;
};

/// Numbers as toUniform gives them: both ends, their neighbours, the powers of two, and random ones.
inline std::vector<float> stressUniforms(std::size_t random = 100) {
    std::vector<float> values{0.0f, 0.25f, 0.75f, 0x1.fffffep-1f, 0x1.fffffcp-1f, 1.0f / 3};
    for (int e = -24; e < 0; ++e) values.push_back(std::exp2(float(e)));
    Stress stress(1);
    while (random-- > 0) values.push_back(stress.between(0, 1));
    return values;
}

/// Unit vectors: along the axes (H10: -z), next to them, in the axes' planes, with negative zeros, and random ones.
inline std::vector<glm::vec3> stressDirections(std::size_t random = 200) {
    std::vector<glm::vec3> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) directions.push_back(glm::normalize(glm::vec3(x, y, z)));
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
            for (const float offset : {1e-30f, 1e-8f, 1e-6f, 1e-4f, 1e-3f, 1e-2f}) {
                glm::vec3 v(offset, -offset, 0.5f * offset);
                v[axis] = sign;
                directions.push_back(glm::normalize(v));
            }
    for (std::size_t i = 0; i < 3; ++i) {
        glm::vec3 v(-0.0f);
        v[int(i)] = -1;
        directions.push_back(v);
    }
    Stress stress(2);
    while (random-- > 0) directions.push_back(stress.direction());
    return directions;
}

}  // namespace parhelion::test
