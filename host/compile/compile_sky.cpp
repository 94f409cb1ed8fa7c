#include "compile/compile_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "compile/distribution_table.h"
#include "compile/luminance.h"
#include "compile/star_field.h"
#include "compile/transforms.h"

namespace parhelion {

namespace {

constexpr double kPi = std::numbers::pi;

/// Largest luminance in each band. It changes one way only with height, so that is at one of the band's ends.
std::vector<double> bandBounds(const SkyDescription& sky) {
    std::vector<double> bounds;
    const auto at = [&](std::uint32_t band) { return luminance(skyGradientAt(sky, double(band) / kSkyBands)); };
    for (std::uint32_t band = 0; band < kSkyBands; ++band) bounds.push_back(std::max(at(band), at(band + 1)));
    return bounds;
}

/// s of the formula: how far t_raw is between the bottom and the top.
double rampAt(const SkyDescription& sky, double tRaw) {
    const double above = tRaw + sky.offset - 0.5;
    return sky.width == 0.0 ? double(above >= 0.0) : std::clamp(above / sky.width + 0.5, 0.0, 1.0);
}

/// Mean of t over the sphere: over t_raw in [0, 1]. Also right where a large power leaves a spot only.
double meanOfT(const SkyDescription& sky) {
    if (sky.power == 0.0) return 1.0;  // 0^0 = 1 below the ramp
    const double low = rampAt(sky, 0.0), high = rampAt(sky, 1.0);
    // So wide that the difference of the integral's ends has no digits: but then t is as good as linear.
    if (sky.width > 1e6) return 0.5 * (std::pow(low, sky.power) + std::pow(high, sky.power));
    const double end = std::clamp(0.5 - sky.offset + 0.5 * sky.width, 0.0, 1.0);  // t is 1 from here on
    const double power = sky.power + 1.0;
    return (1.0 - end) + sky.width / power * (std::pow(high, power) - std::pow(low, power));
}

glm::dvec3 meanOfGradient(const SkyDescription& sky) {
    const double t = meanOfT(sky);
    return (1.0 - t) * sky.bottom + t * sky.top;
}

shared::Sky writeGradient(const SkyDescription& sky, const SourceLocation& where) {
    shared::Sky result{};
    result.axis = glm::vec3(glm::normalize(sky.axis));
    result.offset = float(sky.offset);
    result.width = sky.width < 0x1p-60 ? 0.0f : float(sky.width);
    result.power = sky.power > 0.0 ? std::max(float(sky.power), 1e-30f) : 0.0f;
    result.bottom = toFloat(sky.bottom, where, "sky: bottom");
    result.top = toFloat(sky.top, where, "sky: top");
    result.starRadiance = toFloat(sky.starRadiance, where, "sky: star_radiance");
    result.bandCount = kSkyBands;
    return result;
}

constexpr std::uint32_t kLeastWords = 8;  ///< of the 2^32 that choose, for every band that shines and every star

/// The table of bands and stars, bands first.
///
/// @param share  of the stars in all light.
/// @return the probability of each.
std::vector<double> writeTable(std::span<const double> bands, std::span<const double> stars, double share,
                               CompiledScene& scene) {
    std::vector<double> weights;
    const auto append = [&](std::span<const double> values, double part) {
        const double sum = std::accumulate(values.begin(), values.end(), 0.0);
        for (const double value : values) weights.push_back(sum > 0.0 ? value / sum * part : 0.0);
    };
    append(bands, 1.0 - share);
    append(stars, share);
    DistributionTable table = buildDistribution(weights, kLeastWords);
    scene.constants.sky.distribution = std::uint32_t(scene.distributions.size());
    scene.distributions.insert(scene.distributions.end(), table.texels.begin(), table.texels.end());
    return std::move(table.probabilities);
}

/// @param probabilities  that sampling picks each.
void writeStars(std::span<const Star> stars, double oneMinusCos, std::span<const double> probabilities,
                CompiledScene& scene) {
    const double solidAngle = 2.0 * kPi * oneMinusCos;
    for (std::size_t i = 0; i < stars.size(); ++i) {
        scene.stars.emplace_back(stars[i].direction, float(oneMinusCos));
        scene.stars.emplace_back(float(stars[i].brightness), float(probabilities[i] / solidAngle), 0.0f, 0.0f);
    }
    StarGrid grid = buildStarGrid(stars, oneMinusCos);
    scene.constants.sky.starCount = std::uint32_t(stars.size());
    scene.constants.sky.starCells = grid.cellsPerEdge;
    scene.starCells = std::move(grid.words);
}

}  // namespace

glm::dvec3 skyGradientAt(const SkyDescription& sky, double tRaw) {
    const double t = std::pow(rampAt(sky, tRaw), sky.power);
    return (1.0 - t) * sky.bottom + t * sky.top;
}

bool isUniform(const SkyDescription& sky) {
    const bool hasStars = sky.starDensity > 0.0 && sky.starRadiance != glm::dvec3(0.0);
    return !hasStars && skyGradientAt(sky, 0.0) == skyGradientAt(sky, 1.0);
}

glm::dvec3 compileSky(const SkyDescription& sky, const SourceLocation& where, CompiledScene& scene) {
    std::vector<Star> stars;
    if (sky.starRadiance != glm::dvec3(0.0)) stars = scatterStars(sky, where);
    const double oneMinusCos = starOneMinusCos(sky);
    std::vector<double> brightness;
    for (const Star& star : stars) brightness.push_back(star.brightness);
    const std::vector<double> bounds = bandBounds(sky);
    const bool shines = std::ranges::any_of(bounds, [](double bound) { return bound > 0.0; });
    const glm::dvec3 gradient = shines ? meanOfGradient(sky) : glm::dvec3(0.0);
    const glm::dvec3 starlight =
        0.5 * oneMinusCos * std::accumulate(brightness.begin(), brightness.end(), 0.0) * sky.starRadiance;
    if (gradient + starlight == glm::dvec3(0.0)) return glm::dvec3(0.0);

    scene.constants.sky = writeGradient(sky, where);
    const double share = luminance(starlight) / (luminance(starlight) + luminance(gradient));
    const std::vector<double> probabilities = writeTable(bounds, brightness, share, scene);
    for (const double probability : std::span(probabilities).first(kSkyBands))
        scene.skyBands.push_back(float(probability * kSkyBands / (4.0 * kPi)));
    if (!stars.empty()) writeStars(stars, oneMinusCos, std::span(probabilities).subspan(kSkyBands), scene);
    return gradient + starlight;
}

double skyContrast(const SkyDescription& sky, const CompiledScene& scene) {
    const double gradient = luminance(meanOfGradient(sky)), brightest = luminance(sky.starRadiance);
    double mean = gradient, square = 0.0;
    for (const double bound : bandBounds(sky)) square += bound * bound / kSkyBands;
    for (std::size_t i = 0; i + 1 < scene.stars.size(); i += 2) {
        const double share = 0.5 * scene.stars[i].w, star = scene.stars[i + 1].x * brightest;  // of the sphere
        square += share * star * (star + 2.0 * gradient);
        mean += share * star;
    }
    return square / (mean * mean);
}

}  // namespace parhelion
