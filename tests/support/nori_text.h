#pragma once

#include <gtest/gtest.h>

#include <string>

#include "support/scene_reading.h"

namespace parhelion::test {

/// What a scene in Nori's dialect cannot do without, on one line.
inline const std::string kNoriIntegrator = R"(<integrator type="path_mis_vol"/>)";
inline const std::string kNoriCamera = R"(<camera type="perspective"/>)";

/// A scene in Nori's dialect; the body starts on line 2.
inline std::string noriSceneOf(const std::string& body, const std::string& rest = kNoriIntegrator + kNoriCamera) {
    return "<scene>\n" + body + "\n" + rest + "\n</scene>\n";
}

/// A triangle with texture coordinates, as an OBJ file.
inline const std::string kTriangleObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0.25\nvt 0 1\nf 1/1 2/2 3/3\n";

/// Two texels side by side, (1, 0.5, 0.25) and (2, 1, 0.5), as a Radiance HDR file.
inline const std::string kPairHdr =
    std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") + "\x80\x40\x20\x81" + "\x80\x40\x20\x82";

inline SceneDescription readNori(const std::string& body) { return readText(noriSceneOf(body)); }

/// The point that a transform leads to.
inline glm::dvec3 moved(const glm::dmat4& transform, const glm::dvec3& point) {
    return glm::dvec3(transform * glm::dvec4(point, 1.0));
}

/// Within a few roundings of double.
inline void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-14 * (1 + glm::length(b))) << a.x << " " << a.y << " " << a.z;
}

}  // namespace parhelion::test
