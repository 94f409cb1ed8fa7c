// shaders/light/sky.glsl against double precision, and its gradient against the formula.
#include "reference/light/sky.h"

#include <gtest/gtest.h>

#include "compile/compile_sky.h"
#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/sky_samples.h"

namespace parhelion {
namespace {

using test::ErrorMeter;
using test::HandScene;
using test::Parity;
using test::Stress;

const char* const kShader = "parity/sky.comp";
enum Function : std::uint32_t { kPower, kGradient, kFind, kPoint, kSample };

HandScene skyScene(const SkyDescription& sky) {
    HandScene scene;
    scene.setSky(sky);
    return scene;
}

std::vector<glm::vec4> asInputs(const std::vector<glm::vec3>& directions) {
    std::vector<glm::vec4> inputs;
    for (const glm::vec3& d : directions) inputs.emplace_back(d, 0);
    return inputs;
}

TEST(SkyParity, PowersOfZeroToOneKeepTheirDigits) {
    std::vector<glm::vec4> inputs;
    for (const float power : {0.0f, 1e-30f, 1e-3f, 0.5f, 1.0f, 1.5f, 2.0f, 30.0f, 1e5f, 1e30f})
        for (const float u : test::stressUniforms(300)) {
            inputs.emplace_back(u, 1 - u, power, 0);
            inputs.emplace_back(1 - u, u, power, 0);  // where only the complement has the digits
        }
    const auto outputs = test::SceneProbe(HandScene().scene).run(kShader, kPower, inputs);
    // Logarithm and product 3 of an exponent x, of which exp makes 3 x exp(x) <= 1.2; exp itself 4; the double's
    // base stands for the complement's digits.
    Parity parity("light/sky", "unitPower", 6);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double base = inputs[i].x < 0.5 ? double(inputs[i].x) : 1 - double(inputs[i].y);
        const double expected = reference::unitPower<double>(base, inputs[i].y, inputs[i].z);
        EXPECT_TRUE(parity.near(outputs[i].x, expected, 1)) << inputs[i].x << " ^ " << inputs[i].z;
    }
}

/// Skies at the limits of every parameter.
std::vector<SkyDescription> extremeSkies() {
    std::vector<SkyDescription> skies;
    for (const double width : {0.0, 1e-30, 0.4, 1.0, 1e30})
        for (const double power : {0.0, 1e-40, 0.3, 1e3, 1e30})
            for (const double offset : {0.0, 0.25, 1e30}) {
                SkyDescription sky = test::starrySky();
                sky.starDensity = 0;
                sky.width = width;
                sky.power = power;
                sky.offset = offset;
                skies.push_back(sky);
            }
    return skies;
}

// t_raw has an error of 3 roundings from the chord (a difference, squares and sums of at most 1/2), 3 from the lengths
// of direction and axis, and 2 from shift and sum: the formula between t_raw -+ 8 roundings, which it is monotone in,
// bounds what may come out, up to 6 roundings of the power, 2 of the quotient and 3 of the mix.
TEST(SkyParity, GradientFollowsTheFormulaForEveryParameter) {
    const auto inputs = asInputs(test::stressDirections(100));
    Parity parity("light/sky", "skyGradient", 11);
    constexpr double kRaw = 8 * 0x1p-24;
    for (const SkyDescription& sky : extremeSkies()) {
        const HandScene scene = skyScene(sky);
        const reference::SceneView<double> view(scene.scene);
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kGradient, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::dvec3 d(inputs[i]);
            const double raw = test::rawHeight(sky, d), shift = kRaw * std::max(1.0, std::abs(sky.offset));
            const glm::dvec3 a = test::gradientFormula(sky, raw - shift), b = test::gradientFormula(sky, raw + shift);
            const glm::dvec3 oracle = reference::skyGradient(view, d);
            for (int c = 0; c < 3; ++c) {
                const double low = std::min(a[c], b[c]), high = std::max(a[c], b[c]);
                EXPECT_TRUE(parity.near(outputs[i][c], std::clamp(double(outputs[i][c]), low, high), 1))
                    << i << ": width " << sky.width << ", power " << sky.power << ", offset " << sky.offset;
                EXPECT_TRUE(oracle[c] >= low - 1e-7 && oracle[c] <= high + 1e-7);
            }
        }
    }
}

TEST(SkyParity, AStepIsTopOnItsEdge) {
    SkyDescription sky;
    sky.width = 0;
    sky.top = {1, 2, 3};
    const glm::vec3 above(std::sqrt(1 - 1e-12f), 1e-6f, 0);
    const auto inputs = asInputs({{1, 0, 0}, {0, 0, -1}, above, glm::vec3(1, -1, 1) * above});
    const auto outputs = test::SceneProbe(skyScene(sky).scene).run(kShader, kGradient, inputs);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(glm::vec3(outputs[i]), glm::vec3(1, 2, 3)) << i;
    EXPECT_EQ(glm::vec3(outputs[3]), glm::vec3(0));
}

// Where the formula is steep, the roundings of t_raw grow with its slope (power < 1 has no bound where s is 0): the
// test above.
TEST(SkyParity, GradientIsWithinTwoMillionthsOfTheFormula) {
    double worst = 0;
    for (const double width : {0.5, 0.8, 1.0, 2.0})
        for (const double power : {1.0, 1.5, 3.0}) {
            SkyDescription sky = test::starrySky();
            sky.starDensity = 0;
            sky.width = width;
            sky.power = power;
            const auto inputs = asInputs(test::stressDirections(10'000));
            const auto outputs = test::SceneProbe(skyScene(sky).scene).run(kShader, kGradient, inputs);
            for (std::size_t i = 0; i < inputs.size(); ++i) {
                const double raw = test::rawHeight(sky, glm::dvec3(inputs[i]));
                const glm::dvec3 error = glm::dvec3(outputs[i]) - test::gradientFormula(sky, raw);
                for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(error[c]));
            }
        }
    EXPECT_LE(worst, 2e-6);
    RecordProperty("worst", std::to_string(worst));
    std::printf("gradient: largest error %.2g\n", worst);
}

// A large power leaves a spot about the axis, whose edge 1 - cos alone would blur.
TEST(SkyParity, SpotsAboutTheAxisKeepTheirDigits) {
    constexpr double kAllowed =
        24;  // chord 6, lengths 3 and 10 of (1e-3)^2 against 1e-7^2; logarithm, power, mix 8: of 1
    ErrorMeter ours, naive;
    for (const float power : {1e2f, 1e4f, 1e6f}) {
        SkyDescription sky;
        sky.axis = glm::normalize(glm::dvec3(0.3, 0.4, -0.9));
        sky.power = power;
        sky.top = glm::dvec3(1);
        const HandScene scene = skyScene(sky);
        const glm::vec3 axis = scene.scene.constants.sky.axis;
        std::vector<glm::vec4> inputs;
        Stress stress(62);
        for (int i = 0; i < 2'000; ++i) {
            const double radius = stress.magnitude(1e-3f, 1);
            inputs.emplace_back(test::besideStar(glm::vec4(axis, 0.5f), radius, stress.between(0, 6)), 0);
        }
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kGradient, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(inputs[i])), a = glm::normalize(glm::dvec3(axis));
            const double expected = std::pow(1 - 0.25 * glm::dot(d - a, d - a), double(power));
            EXPECT_LT(ours.add(outputs[i].x, expected, 1), kAllowed) << power;
            naive.add(std::pow(0.5 + 0.5 * double(glm::dot(glm::vec3(inputs[i]), axis)), double(power)), expected, 1);
        }
    }
    EXPECT_GT(naive.worst(), 100 * kAllowed);
}

/// Whether rounding may put a direction into the next cell.
bool isAtCellBorder(glm::dvec3 d, double cells) {
    const glm::dvec3 a = glm::abs(d);
    const double major = std::max({a.x, a.y, a.z});
    bool nearTie = false, onBorder = false;
    for (int i = 0; i < 3; ++i) {
        nearTie = nearTie || (a[i] > major * (1 - 1e-6) && a[i] < major);  // exact ties have an order
        const double place = (0.5 + 0.5 * d[i] / major) * cells;
        onBorder = onBorder || (a[i] < major && std::abs(place - std::round(place)) < 1e-6 * cells);
    }
    return onBorder || nearTie;
}

TEST(SkyParity, StarsAreFoundWhereTheyAre) {
    // From 1e-3 degrees: 150 roundings of a direction in radius.
    for (const double size : {1e-3, 0.01, 0.3, 2.0}) {
        const HandScene scene = skyScene(test::starrySky(size));
        const reference::SceneView<double> view(scene.scene);
        const auto inputs = asInputs(test::skyDirections(scene.scene, 3'000));
        const auto outputs = test::SceneProbe(scene.scene).run(kShader, kFind, inputs);
        Parity cell("light/sky", "starCell", 0), star("light/sky", "findStar", 0);
        std::size_t found = 0;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::dvec3 d(inputs[i]);
            const glm::uvec4 words = glm::floatBitsToUint(outputs[i]);
            if (!isAtCellBorder(d, scene.scene.constants.sky.starCells)) {
                EXPECT_TRUE(cell.equal(words.x, reference::starCell(view, d))) << i;
            }
            // Rims are sampled a thousandth of a radius off; the chord has 5 roundings.
            EXPECT_TRUE(star.equal(words.y, reference::findStar(view, d))) << i << ", size " << size;
            found += words.y != shared::kNone;
        }
        EXPECT_GT(found, 3 * scene.scene.constants.sky.starCount);
    }
}

/// Whether rounding may put a direction into the next band.
bool isAtBandBorder(const SkyDescription& sky, const glm::dvec3& d) {
    const double place = test::rawHeight(sky, d) * kSkyBands;
    return std::abs(place - std::round(place)) < kSkyBands * 8 * 0x1p-24;
}

TEST(SkyParity, RadianceAndDensityOfPointsAgree) {
    const SkyDescription sky = test::starrySky();
    const HandScene scene = skyScene(sky);
    const reference::SceneView<double> view(scene.scene);
    const auto inputs = asInputs(test::skyDirections(scene.scene, 3'000));
    const auto outputs = test::SceneProbe(scene.scene).run(kShader, kPoint, inputs);
    // The gradient's slope of 2 in t_raw (8 roundings) and the rest (11); a star's product and a sum.
    Parity radiance("light/sky", "skyRadiance", 2 * 8 + 11 + 2);
    Parity pdf("light/sky", "skyPdf", 1);  // a sum
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 d(inputs[i]);
        const reference::SkyPoint<double> point{d, reference::findStar(view, d)};
        const glm::dvec3 expected = reference::skyRadiance(view, point);
        EXPECT_TRUE(radiance.near(outputs[i], expected, std::max(1.0, expected.z))) << i;
        if (!isAtBandBorder(sky, d)) {
            EXPECT_TRUE(pdf.near(outputs[i].w, reference::skyPdf(view, point))) << i;
        }
    }
}

TEST(SkyParity, SamplesAgree) {
    const HandScene scene = skyScene(test::starrySky());
    const reference::SceneView<double> view(scene.scene);
    std::vector<glm::vec4> inputs;
    Stress stress(63);
    for (int i = 0; i < 20'000; ++i) {
        glm::uvec4 words;
        for (int c = 0; c < 4; ++c) words[c] = stress.word();
        if (i % 16 < 3) words[i % 16] = i % 32 < 16 ? 0u : 0xffffffffu;
        inputs.push_back(glm::uintBitsToFloat(words));
    }
    const auto outputs = test::SceneProbe(scene.scene).run(kShader, kSample, inputs);
    // Warp and basis (10 + 11 in three components), normalisation 9; the heights of a band, products and root 6.
    Parity direction("light/sky", "sampleSky", 3 * 27 + 9);
    std::size_t stars = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::uvec4 words = glm::floatBitsToUint(inputs[i]);
        const auto expected = reference::sampleSky(view, words);
        const std::uint32_t star = glm::floatBitsToUint(outputs[i].w);
        EXPECT_TRUE(direction.near(outputs[i], expected.direction)) << i;
        EXPECT_EQ(star, expected.star) << i;
        stars += star != shared::kNone;
    }
    EXPECT_GT(stars, 1'000u);
}

}  // namespace
}  // namespace parhelion
