#include <gtest/gtest.h>

#include "reference/integrator/path_tracer.h"
#include "support/goodness.h"
#include "support/hand_scene.h"

// Which collisions go on. Absorption is not drawn apart: a collision multiplies the path by the albedo, and roulette on
// the product ends it. From the first collision on, that is the analog choice between scattering and absorption.
namespace parhelion::reference {
namespace {

using test::CellTest;

double significance() { return sidak(test::kFamilySignificance, 8); }

/// Collisions in a grey medium, roulette from the first on.
class Collisions {
public:
    explicit Collisions(float albedo) {
        scene_.addHomogeneous(1, glm::vec3(albedo));
        scene_.setEnvironment(glm::vec3(0));
        scene_.scene.constants.rouletteDepth = 1;
        quality_.sobol = false;
    }

    /// Throughput after collision number i of its own path; 0 if the path ends.
    float scatterOnce(std::uint32_t i) {
        const PathContext<float, NoTrace> path{view(), quality_, streamOf(i, 0, 0, 0), 0, counters_, trace_};
        Vertex<float> vertex;
        vertex.medium = &view().media[0];
        vertex.wo = {0, 0, 1};
        vertex.index = 1;
        PathState<float> state;
        return scatter(path, vertex, view().media[0].albedo, state) ? state.throughput.beta.x : 0.0f;
    }

private:
    const SceneView<float>& view() {
        if (!view_) view_.emplace(scene_.scene);
        return *view_;
    }

    test::HandScene scene_;
    std::optional<SceneView<float>> view_;
    Quality quality_;
    Counters counters_{};
    NoTrace trace_;
};

// The baseline's test of this name: 0.75 : 0.25, there 79 116 events with p = 0.799.
TEST(BaselineScatterOrAbsorb, ChiSquareOfTheTwoOutcomes) {
    CellTest cells({0.75, 0.25}, significance()), defect({0.75, 0.25}, significance());
    Collisions collisions(0.75f), brighter(0.755f);
    for (auto i = std::uint32_t(cells.samplesNeeded()); i > 0; --i) {
        const float beta = collisions.scatterOnce(i);
        ASSERT_TRUE(beta == 0 || beta == 1) << "what goes on has lost nothing";
        cells.add(beta > 0 ? 0 : 1);
        defect.add(brighter.scatterOnce(i) > 0 ? 0 : 1);
    }
    cells.expectFit("scatter or absorb");
    defect.expectMisfit("albedo 0.755");
}

TEST(BaselineScatterOrAbsorb, TheExpectedWeightIsTheAlbedo) {
    for (const float albedo : {0.75f, 0.4f}) {
        Collisions collisions(albedo), defect(1.01f * albedo);
        RunningMoments moments, seeded;
        const double variation = std::sqrt(1 / double(albedo) - 1);
        for (auto i = std::uint32_t(sampleSizeFor(test::kDistortion, variation, significance())); i > 0; --i) {
            moments.add(double(collisions.scatterOnce(i)));
            seeded.add(double(defect.scatterOnce(i)));
        }
        test::expectMean(moments, double(albedo), significance(), "albedo " + std::to_string(albedo));
        EXPECT_FALSE(test::agrees(seeded, double(albedo), significance())) << "off by 1 %";
    }
    // One in twenty goes on at least, the darker for it.
    Collisions dark(0.02f);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const float beta = dark.scatterOnce(i);
        EXPECT_FLOAT_EQ(beta, beta > 0 ? 0.02f / 0.05f : 0);
    }
}

}  // namespace
}  // namespace parhelion::reference
