// The comparison in words: for readers by `describe`, for scripts by `identifierOf`.
#include <fmt/format.h>

#include <iterator>

#include "analysis/compare.h"

namespace parhelion {

namespace {

std::string_view explanationOf(NoiseSource source) {
    switch (source) {
        case NoiseSource::none:
            return "unknown: no variance layers, so no test";
        case NoiseSource::imageA:
            return "of the first image; the second counts as exact";
        case NoiseSource::imageB:
            return "of the second image; the first counts as exact";
        case NoiseSource::both:
            return "of both images";
    }
    return "";
}

std::string_view explanationOf(ComparisonVerdict verdict) {
    switch (verdict) {
        case ComparisonVerdict::identical:
            return "identical: no value of R, G and B differs";
        case ComparisonVerdict::notFinite:
            return "NOT FINITE: values that are not finite are left out of every figure";
        case ComparisonVerdict::noiseUnknown:
            return "different; without variance layers nothing tells whether noise explains it";
        case ComparisonVerdict::differ:
            return "DIFFERENT: by more than noise";
        case ComparisonVerdict::moreNoise:
            return "MORE THAN NOISE: means, tiles and pixels agree, but the squared error is above both variances: a "
                   "difference spread over the pixels, or variances that are too small";
        case ComparisonVerdict::lessNoise:
            return "less noise than independent renders would have: the same random numbers in both, stratified "
                   "(Sobol) points, whose sample variance overestimates, or an image smoothed after its variance was "
                   "measured; the tests below do not see differences far under that noise";
        case ComparisonVerdict::agree:
            return "agree: noise or rounding explains the difference";
    }
    return "";
}

std::string_view levelOf(const NoiseBudget& budget) {
    if (budget.isMore()) return "MORE THAN NOISE";
    return budget.isLess() ? "less than independent noise" : "noise alone";
}

std::string describeValues(const ImageComparison& comparison) {
    std::string text = fmt::format("values with different bits: {} of {}\n", comparison.differing, comparison.values);
    if (comparison.nonFinite > 0)
        text += fmt::format("values not finite: {} (first image {}, second image {})\n", comparison.nonFinite,
                            comparison.nonFiniteA, comparison.nonFiniteB);
    return text;
}

std::string describeMeans(const ChannelMeans& means) {
    std::string text = fmt::format("mean {}: {:.8g} against {:.8g}", means.channel, means.meanA, means.meanB);
    if (means.ratio) text += fmt::format(", ratio {:.6f}", *means.ratio);
    if (const auto& interval = means.ratioConfidence)
        text += fmt::format(" [{:.6f}, {:.6f}]", (*interval)[0], (*interval)[1]);
    return text + '\n';
}

}  // namespace

std::string_view identifierOf(ComparisonVerdict verdict) {
    switch (verdict) {
        case ComparisonVerdict::identical:
            return "identical";
        case ComparisonVerdict::notFinite:
            return "notFinite";
        case ComparisonVerdict::noiseUnknown:
            return "noiseUnknown";
        case ComparisonVerdict::differ:
            return "differ";
        case ComparisonVerdict::moreNoise:
            return "moreNoise";
        case ComparisonVerdict::lessNoise:
            return "lessNoise";
        case ComparisonVerdict::agree:
            return "agree";
    }
    return "";
}

std::string_view identifierOf(NoiseSource source) {
    switch (source) {
        case NoiseSource::none:
            return "none";
        case NoiseSource::imageA:
            return "imageA";
        case NoiseSource::imageB:
            return "imageB";
        case NoiseSource::both:
            return "both";
    }
    return "";
}

std::string describe(const LargestDeviation& deviation) {
    return fmt::format("largest |z| {:.2f}, limit {:.2f} for {} tests{}: {}", std::abs(deviation.z),
                       deviation.threshold, deviation.tests,
                       deviation.channel.empty() ? ""
                                                 : fmt::format(", channel {} at pixel ({}, {})", deviation.channel,
                                                               deviation.pixel.x, deviation.pixel.y),
                       deviation.passed() ? "agrees" : "DIFFERS");
}

std::string describe(const NoiseBudget& budget) {
    return fmt::format(
        "squared error over both variances: {:.4g} [{:.4g}, {:.4g}], z {:.2f}, limit {:.2f}: {}\n"
        "systematic difference: at most {:.3g}, root mean square over pixels\n",
        budget.ratio, budget.ratioConfidence[0], budget.ratioConfidence[1], budget.z, budget.threshold, levelOf(budget),
        budget.largestBias);
}

std::string describe(const ImageComparison& comparison) {
    const ComparisonVerdict verdict = comparison.verdict();
    std::string text = fmt::format(
        "{}\n{}mean squared error {:.6g}, mean absolute error {:.6g}, largest error {:.6g}\n"
        "relative mean squared error {:.6g} (epsilon {:.3g})\n",
        explanationOf(verdict), describeValues(comparison), comparison.meanSquaredError, comparison.meanAbsoluteError,
        comparison.maxAbsoluteError, comparison.relativeMse, comparison.relativeMseEpsilon);
    for (const ChannelMeans& means : comparison.channels) text += describeMeans(means);
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "noise {}\n", explanationOf(comparison.noise));
    // Tests of a difference that is not there would say nothing.
    if (verdict == ComparisonVerdict::identical) return text;
    if (comparison.budget) fmt::format_to(out, "{}", describe(*comparison.budget));
    if (comparison.means) fmt::format_to(out, "image means: {}\n", describe(*comparison.means));
    if (comparison.tiles) fmt::format_to(out, "8 x 8 tiles: {}\n", describe(*comparison.tiles));
    if (comparison.pixels) fmt::format_to(out, "pixels: {}\n", describe(*comparison.pixels));
    return text;
}

}  // namespace parhelion
