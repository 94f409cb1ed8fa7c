// shaders/volume/majorant.glsl against double precision.
#include "reference/volume/majorant.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::kRounding;
using test::Parity;
using test::Stress;

constexpr glm::uvec3 kResolution(40, 17, 9);

/// H25: voxels of different sizes along the axes. Every majorant cell, of 8 * 2^level voxels, has its own bound.
test::HandScene majorantScene(std::uint32_t level) {
    test::HandScene built;
    const std::vector<float> voxels(kResolution.x * kResolution.y * kResolution.z, 1.0f);
    built.addGrid(1, glm::vec3(1), kResolution, voxels, {-1, -2, -0.05f}, {1, 3, 0.05f});
    shared::Medium& medium = built.scene.constants.media[0];
    medium.cellLevel = level;
    medium.cells = (kResolution + (8u << level) - 1u) / (8u << level);
    built.scene.majorants.resize(std::size_t(medium.cells.x) * medium.cells.y * medium.cells.z);
    for (std::size_t i = 0; i < built.scene.majorants.size(); ++i) built.scene.majorants[i] = 1 + float(i);
    return built;
}

/// Origin and distance; direction. Along the axes and in the planes of cells (H27), from within and from outside.
std::vector<glm::vec4> rays() {
    std::vector<glm::vec4> inputs;
    Stress stress(21);
    for (const glm::vec3& direction : test::stressDirections(3'000))
        for (int i = 0; i < 3; ++i) {
            inputs.emplace_back(stress.between(-1.2f, 1.2f), stress.between(-2.2f, 3.2f), stress.between(-0.06f, 0.06f),
                                i == 0 ? 0.0f : stress.between(0, 1));
            inputs.emplace_back(direction, 0);
        }
    return inputs;
}

class MajorantParity : public testing::TestWithParam<std::uint32_t> {
protected:
    static constexpr std::size_t kRows = 6;

    /// How much one rounding of the ray's origin in voxel units is, per axis.
    glm::dvec3 sizeOf(const reference::CellWalk<double>& walk) const {
        return glm::abs(walk.origin) + 2.0 * glm::abs(medium_.gridFromWorld.translation);
    }
    reference::CellWalk<double> walkOf(std::size_t i) const {
        return reference::gridRay(medium_, glm::dvec3(inputs_[2 * i]), glm::dvec3(inputs_[2 * i + 1]));
    }

    test::HandScene built_ = majorantScene(GetParam());
    reference::SceneView<double> view_{built_.scene};
    const reference::Medium<double>& medium_ = view_.media[0];
    std::vector<glm::vec4> inputs_ = rays();
    std::vector<glm::vec4> outputs_ = test::SceneProbe(built_.scene).run("parity/majorant.comp", 0, inputs_, 2, kRows);
};

// H39: 0 * infinity of rays that run along the grid's faces.
TEST_P(MajorantParity, RayAndItsWayThroughTheGridAgreeH39) {
    // Rows of the affine map: three products and sums.
    Parity affine("volume/majorant", "gridRay", 6);
    // Origin 6, difference 1, quotient of a sum of three (2.5 ulp, 5) 11, product 1.
    Parity interval("volume/majorant", "gridInterval", 19);
    for (std::size_t i = 0; i < inputs_.size() / 2; ++i) {
        const reference::CellWalk<double> walk = walkOf(i);
        const glm::dvec3 size = sizeOf(walk), along = glm::abs(walk.direction);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_TRUE(affine.near(outputs_[kRows * i][axis], walk.origin[axis], size[axis])) << i;
            EXPECT_TRUE(affine.near(outputs_[kRows * i + 1][axis], walk.direction[axis])) << i;
        }
        const glm::dvec2 expected = reference::gridInterval(medium_, walk);
        double scale = 0;
        for (int axis = 0; axis < 3; ++axis)
            if (along[axis] > 0) scale = std::max(scale, (size[axis] + medium_.resolution[axis]) / along[axis]);
        if (std::abs(expected.y - expected.x) < 40 * kRounding * scale) continue;  // touches an edge
        const glm::vec4 got = outputs_[kRows * i + 5];
        ASSERT_EQ(got.x <= got.y, expected.x <= expected.y) << i;
        if (!(expected.x <= expected.y)) continue;
        EXPECT_TRUE(interval.near(got.x, expected.x, scale)) << i;
        EXPECT_TRUE(interval.near(got.y, expected.y, scale)) << i;
    }
}

// H26: planes from the integer cell; H27: no 0 * infinity where the ray does not move along an axis.
TEST_P(MajorantParity, CellsAgreeStepByStepH25H26H27) {
    Parity cell("volume/majorant", "startCell", 0), bound("volume/majorant", "majorantAt", 0);
    Parity planes("volume/majorant", "planeDistances", 19), next("volume/majorant", "nextCell", 0);
    int compared = 0;
    for (std::size_t i = 0; i < inputs_.size() / 2; ++i) {
        const glm::vec4* rows = &outputs_[kRows * i];
        reference::CellWalk<double> walk = walkOf(i);
        reference::startCell(medium_, double(inputs_[2 * i].w), walk);
        const glm::dvec3 p = (walk.origin + walk.t * walk.direction) / double(shared::kVoxelsPerCell << GetParam());
        const glm::dvec3 toPlane = glm::abs(p - glm::round(p)), size = sizeOf(walk);
        if (std::min({toPlane.x, toPlane.y, toPlane.z}) < 1e-4) continue;  // on a plane: either cell will do
        ++compared;
        EXPECT_TRUE(cell.near(rows[2], walk.cell)) << i;
        EXPECT_TRUE(bound.near(rows[0].w, walk.bound)) << i;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = std::abs(walk.direction[axis]);
            const double scale = d > 0 ? (size[axis] + std::abs(d * walk.planes[axis])) / d : 0;
            EXPECT_TRUE(planes.near(rows[3][axis], walk.planes[axis], scale)) << i << ", axis " << axis;
        }
        glm::dvec3 sorted = walk.planes;
        std::sort(&sorted[0], &sorted[0] + 3);
        if (std::isinf(sorted[0]) || sorted[1] - sorted[0] < 1e-4 * std::abs(sorted[1])) continue;  // a corner
        reference::nextCell(medium_, walk, reference::nearestAxis(walk));
        EXPECT_TRUE(next.near(rows[4], walk.cell)) << i;
    }
    EXPECT_GT(compared, 5'000);
}

INSTANTIATE_TEST_SUITE_P(CellLevels, MajorantParity, testing::Values(0u, 1u, 2u));

}  // namespace
}  // namespace parhelion
