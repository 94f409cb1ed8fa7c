#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "reference/reference_renderer.h"
#include "support/hand_scene.h"

namespace parhelion {
namespace {

using test::HandScene;
using test::PixelEstimate;

using Row = std::map<std::string, std::string>;

std::vector<Row> readTable(const std::filesystem::path& path) {
    std::ifstream file(path);
    const auto cells = [](const std::string& line) {
        std::vector<std::string> values;
        std::stringstream stream(line);
        for (std::string value; std::getline(stream, value, ',');) values.push_back(value);
        return values;
    };
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> names = cells(line);
    std::vector<Row> rows;
    while (std::getline(file, line)) {
        const std::vector<std::string> values = cells(line);
        Row row;
        for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
        rows.push_back(row);
    }
    return rows;
}

struct Slab {
    float tau, albedo, g;
};

/// Radiance of the slab seen from above at cosine mu under a uniform unit sky from above or from below. By
/// reciprocity it is the slab's albedo, or its transmittance, for light incident at mu.
PixelEstimate seeSlab(const Slab& slab, double mu, bool litFromAbove, bool inDouble, std::uint64_t samples) {
    HandScene scene;
    scene.lookAlong({float(std::sqrt(1 - mu * mu)), 0, float(-mu)});
    const std::uint32_t black = scene.addDiffuse(glm::vec3(0), shared::kShapeTwoSided);
    const std::uint32_t fog = scene.addNull(scene.addHomogeneous(1, glm::vec3(slab.albedo), slab.g));
    // 2000 mean free paths wide: what leaves at the sides is below 1e-3 of a mean free path / 1000.
    const float bottom = -1 - slab.tau, screen = litFromAbove ? bottom - 1 : 1;
    scene.addQuad({-1e6f, -1e6f, screen}, {2e6f, 0, 0}, {0, 2e6f, 0}, black);
    scene.addBox({-1000, -1000, bottom}, {1000, 1000, -1}, fog);
    scene.setEnvironment(glm::vec3(1));
    return test::renderPixel(scene.scene, samples, inDouble);
}

class Scores {
public:
    void add(const PixelEstimate& found, double exact, const std::string& what) {
        // The table has 7 decimals; a channel that hardly varies must agree to the float's rounding.
        const double z = (found.mean - exact) / std::hypot(found.error, 2e-6);
        // Two-sided 1e-6 over about 100 comparisons.
        EXPECT_LT(std::abs(z), 5.8) << what << ": " << found.mean << " +- " << found.error << ", exact " << exact;
        sum_ += z;
        ++count_;
    }
    /// A bias common to all, too small for any one of them to show.
    void expectNoCommonBias() const { EXPECT_LT(std::abs(sum_) / std::sqrt(double(count_)), 4.9) << sum_; }

private:
    double sum_ = 0;
    int count_ = 0;
};

// Wrong extinction (x 0.98), albedo or g (+ 0.01), a lost boundary or a repeated random number all show here.
TEST(ReferenceSlab, MatchesAddingDoubling) {
    const std::filesystem::path path = PARHELION_ROOT "/../shared/references/slabs.csv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
    Scores scores;
    int compared = 0;
    for (const Row& row : readTable(path)) {
        const Slab slab{std::stof(row.at("tau")), std::stof(row.at("albedo")), std::stof(row.at("g"))};
        if (row.at("phase") != "HG" || slab.tau > 5) continue;
        const std::string name = fmt::format("tau {} albedo {} g {}", slab.tau, slab.albedo, slab.g);
        const bool inDouble = ++compared % 2 == 0;
        const auto compare = [&](const char* column, double mu, bool above) {
            scores.add(seeSlab(slab, mu, above, inDouble, 60000), std::stod(row.at(column)), name + " " + column);
        };
        compare("R_mu1", 1, true);
        compare("Ttot_mu1", 1, false);
        compare("R_mu05", 0.5, true);
        compare("Ttot_mu05", 0.5, false);
    }
    EXPECT_GE(compared, 10);
    scores.expectNoCommonBias();
}

TEST(ReferenceSlab, MatchesPublishedValues) {
    // Chandrasekhar's and van de Hulst's numbers, as recomputed by adding-doubling to 6 decimals.
    Scores scores;
    scores.add(seeSlab({1, 1.0f, 0}, 1, true, true, 100000), 0.341329, "tau 1");
    scores.add(seeSlab({4, 0.99f, 0}, 1, true, true, 50000), 0.645047, "tau 4");
    scores.add(seeSlab({2, 0.9f, 0.75f}, 1, true, false, 200000), 0.0973946, "van de Hulst R");
    scores.add(seeSlab({2, 0.9f, 0.75f}, 1, false, false, 100000), 0.6609577, "van de Hulst T");
    scores.add(seeSlab({2, 0.9f, -0.5f}, 1, true, false, 100000), 0.462772, "backward R");
    scores.add(seeSlab({64, 0.9f, 0}, 1, true, false, 100000), 0.414947, "half-space");
    scores.expectNoCommonBias();
}

TEST(ReferenceSlab, OpticalDepthIsIndependentOfScale) {  // H29, H85
    // A slab of the same optical thickness, 2^20 times as small or large: the same paths to the bit.
    const auto film = [](float scale) {
        HandScene scene;
        scene.lookAlong({0.6f, 0, -0.8f});
        const std::uint32_t fog = scene.addNull(scene.addHomogeneous(1 / scale, glm::vec3(0.9f), 0.6f));
        scene.addBox(scale * glm::vec3(-100, -100, -5), scale * glm::vec3(100, 100, -1), fog);
        scene.setEnvironment(glm::vec3(1));
        RenderSettings settings;
        settings.sampleCount = 1000;
        return reference::render<float>(scene.scene, settings).pixels.at(0).sumHigh.x;
    };
    EXPECT_EQ(film(0x1p-20f), film(1));
    EXPECT_EQ(film(0x1p20f), film(1));
}

}  // namespace
}  // namespace parhelion
