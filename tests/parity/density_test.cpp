// shaders/volume/density.glsl against double precision: dense and bricked, one corner and eight.
#include "reference/volume/density.h"

#include <gtest/gtest.h>

#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

namespace parhelion {
namespace {

using test::Parity;
using test::Stress;

const char* const kShader = "parity/density.comp";
enum Function : std::uint32_t { kVoxel, kLookups, kAlbedo, kColorVoxel, kAnyVoxel };
enum class Storage { Dense, Bricked, Colored };

/// H23: grids of one voxel and one voxel thick, and a larger one; with albedo grids.
test::HandScene gridScene() {
    test::HandScene built;
    Stress stress(19);
    for (const glm::uvec3 resolution : {glm::uvec3(1), glm::uvec3(1, 7, 3), glm::uvec3(21, 9, 17)}) {
        std::vector<float> voxels(resolution.x * resolution.y * resolution.z);
        for (float& voxel : voxels) voxel = stress.word() % 4 == 0 ? 0.0f : stress.between(0, 1);
        const std::uint32_t index = built.addGrid(1, {0.9f, 0.8f, 0.7f}, resolution, voxels, {-1, -2, 0}, {1, 3, 4});
        shared::Medium& medium = built.medium(index);
        if (resolution.x == 1) continue;
        medium.flags |= shared::kMediumAlbedoGrid;
        medium.albedoFromWorld = medium.gridFromWorld;
        medium.albedoResolution = resolution;
        medium.albedoOffset = std::uint32_t(built.scene.albedoVoxels.size());
        for (std::size_t i = 0; i < voxels.size(); ++i)
            built.scene.albedoVoxels.emplace_back(stress.between(0, 1), stress.between(0, 1), stress.between(0, 1), 0);
    }
    return built;
}

/// The same densities as bricks of 8^3; those that hold nothing are left out.
test::HandScene brickedScene() {
    test::HandScene built = gridScene();
    const std::vector<float> dense = std::move(built.scene.density);
    built.scene.density.clear();
    for (std::uint32_t m = 0; m < built.scene.constants.mediumCount; ++m) {
        shared::Medium& medium = built.medium(m);
        const glm::uvec3 n = medium.resolution;
        const std::uint32_t first = medium.voxelOffset;
        medium.voxelOffset = std::uint32_t(built.scene.brickTable.size());
        medium.flags |= shared::kMediumBricked;
        for (std::uint32_t brick = 0; brick < medium.cells.x * medium.cells.y * medium.cells.z; ++brick) {
            const glm::uvec3 base(brick % medium.cells.x, brick / medium.cells.x % medium.cells.y,
                                  brick / medium.cells.x / medium.cells.y);
            const bool isEmpty = m == 2 && brick % 3 == 0;
            built.scene.brickTable.push_back(isEmpty ? shared::kEmptyBrick : std::uint32_t(built.scene.density.size()));
            for (std::uint32_t i = 0; i < 512 && !isEmpty; ++i) {
                const glm::uvec3 v = base * 8u + glm::uvec3(i % 8, i / 8 % 8, i / 64);
                const bool isInside = glm::all(glm::lessThan(v, n));
                built.scene.density.push_back(isInside ? dense[first + (v.z * n.y + v.y) * n.x + v.x] : 0.0f);
            }
        }
    }
    return built;
}

/// The grids of gridScene, each with two more values a voxel.
test::HandScene colorScene() {
    test::HandScene built = gridScene();
    Stress stress(21);
    std::vector<float> interleaved;
    for (const float value : built.scene.density)
        for (const float channel : {value, stress.between(0, 1), stress.word() % 3 == 0 ? 0.0f : stress.between(0, 1)})
            interleaved.push_back(channel);
    built.scene.density = std::move(interleaved);
    for (std::uint32_t m = 0; m < built.scene.constants.mediumCount; ++m) {
        built.medium(m).flags |= shared::kMediumColorDensity;
        built.medium(m).voxelOffset *= 3;
    }
    return built;
}

class DensityParity : public testing::TestWithParam<Storage> {
protected:
    /// Positions in voxel units: outside, on faces, on and between voxel centres. Index in the fourth component.
    std::vector<glm::vec4> lookups() const {
        std::vector<glm::vec4> inputs;
        Stress stress(20);
        const auto uniforms = test::stressUniforms();
        for (std::uint32_t m = 0; m < view_.media.size(); ++m)
            for (int i = 0; i < 6'000; ++i) {
                glm::vec3 p;
                for (int axis = 0; axis < 3; ++axis) {
                    const float n = float(view_.media[m].resolution[axis]);
                    p[axis] = stress.between(-2, n + 2);
                    if (i % 4 == 0) p[axis] = std::floor(p[axis]) + 0.5f;
                    if (i % 4 == 1) p[axis] = std::floor(p[axis]);
                }
                inputs.emplace_back(p, glm::uintBitsToFloat(m));
                inputs.emplace_back(uniforms[stress.word() % uniforms.size()],
                                    uniforms[stress.word() % uniforms.size()], stress.between(0, 1), 0);
            }
        return inputs;
    }
    std::uint32_t mediumOf(const glm::vec4& input) const { return glm::floatBitsToUint(input.w); }

    bool isColored() const { return GetParam() == Storage::Colored; }

    test::HandScene built_ = GetParam() == Storage::Bricked ? brickedScene() : isColored() ? colorScene() : gridScene();
    reference::SceneView<double> view_{built_.scene};
    Quality trilinear_ = [] {
        Quality quality;
        quality.stochasticFilter = false;
        return quality;
    }();
};

TEST_P(DensityParity, EveryVoxelIsTheSame) {
    std::vector<glm::vec4> inputs;
    for (std::uint32_t m = 0; m < view_.media.size(); ++m) {
        const glm::ivec3 n = view_.media[m].resolution;
        for (int z = 0; z < n.z; ++z)
            for (int y = 0; y < n.y; ++y)
                for (int x = 0; x < n.x; ++x) inputs.emplace_back(x, y, z, glm::uintBitsToFloat(m));
    }
    const auto values = test::SceneProbe(built_.scene).run(kShader, kAnyVoxel, inputs);
    Parity any("volume/density", "voxelAt", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        EXPECT_TRUE(any.near(values[i], reference::voxelAt(view_.media[mediumOf(inputs[i])], glm::ivec3(inputs[i]))));
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, isColored() ? kColorVoxel : kVoxel, inputs);
    Parity parity("volume/density", isColored() ? "colorVoxel" : "densityVoxel", 0);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto& medium = view_.media[mediumOf(inputs[i])];
        const glm::ivec3 voxel(inputs[i]);
        if (isColored())
            EXPECT_TRUE(parity.near(outputs[i], reference::colorVoxel(medium, voxel)));
        else
            EXPECT_TRUE(parity.near(outputs[i].x, reference::densityVoxel(medium, voxel)));
    }
}

// H18: nothing negative comes out; H74: no interpolation of 8 bits.
TEST_P(DensityParity, LookupsAgreeInsideOnAndOutsideTheGridH18H74) {
    const auto inputs = lookups();
    const auto stochastic = test::SceneProbe(built_.scene).run(kShader, kLookups, inputs, 2, 3);
    const auto trilinear = test::SceneProbe(built_.scene, trilinear_).run(kShader, kLookups, inputs, 2, 3);
    Parity corner("volume/density", "stochasticCorner", 0);
    // Three interpolations of two products, a difference and a sum each; p - 0.5 and its fraction (of positions up to
    // 24 voxels, 2^-24 * 32 each) move each weight.
    Parity eight("volume/density", "trilinearDensity", 3 * (4 + 2 * 32)),
        any("volume/density", "densityAt", 3 * (4 + 2 * 32));
    std::size_t compared = 0;
    for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
        const auto& medium = view_.media[mediumOf(inputs[2 * i])];
        const glm::dvec3 p(inputs[2 * i]), u(inputs[2 * i + 1]);
        const glm::dvec3 smooth = reference::trilinearDensity(medium, p);
        EXPECT_TRUE(eight.near(stochastic[3 * i + 1], smooth, 1)) << i;
        EXPECT_TRUE(any.near(trilinear[3 * i + 2], smooth, 1)) << i;
        for (int c = 0; c < 3; ++c) EXPECT_GE(trilinear[3 * i + 2][c], 0.0f) << i;
        const glm::dvec3 gap = glm::abs(glm::fract(p - 0.5) - u);
        if (std::min({gap.x, gap.y, gap.z}) < 4e-6) continue;  // u decides within rounding of the fraction
        ++compared;
        const glm::ivec3 expected = glm::clamp(reference::stochasticCorner(p, u), glm::ivec3(0), medium.resolution - 1);
        EXPECT_TRUE(corner.near(stochastic[3 * i], expected)) << i;
        EXPECT_TRUE(any.near(stochastic[3 * i + 2], reference::densityAt(medium, p, u, true))) << i;
    }
    EXPECT_GT(compared, 10'000u);
}

TEST_P(DensityParity, AlbedoIsThatOfTheSameCorner) {
    const auto inputs = lookups();
    const auto outputs = test::SceneProbe(built_.scene).run(kShader, kAlbedo, inputs, 2, 1);
    Parity parity("volume/density", "albedoAt", 0);
    for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
        const auto& medium = view_.media[mediumOf(inputs[2 * i])];
        const glm::dvec3 p(inputs[2 * i]), u(inputs[2 * i + 1]);
        const glm::dvec3 s = medium.albedoVoxels ? medium.albedoFromWorld.point(p) - 0.5 : glm::dvec3(0.5);
        const glm::dvec3 gap = glm::abs(glm::fract(s) - u), seam = glm::abs(glm::fract(s + 0.5) - 0.5);
        if (std::min({gap.x, gap.y, gap.z}) < 4e-5 || std::max({seam.x, seam.y, seam.z}) > 0.5 - 4e-5) continue;
        EXPECT_TRUE(parity.near(outputs[i], reference::albedoAt(medium, p, u))) << i;
    }
}

std::string nameOf(const testing::TestParamInfo<Storage>& info) {
    static constexpr const char* kNames[] = {"Dense", "Bricked", "Colored"};
    return kNames[std::size_t(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Storage, DensityParity, testing::Values(Storage::Dense, Storage::Bricked, Storage::Colored),
                         nameOf);

}  // namespace
}  // namespace parhelion
