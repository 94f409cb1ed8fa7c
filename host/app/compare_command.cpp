#include "app/compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/compare.h"
#include "app/exit_codes.h"
#include "app/interrupt.h"
#include "app/output_check.h"
#include "app/text_format.h"
#include "base/files.h"

namespace parhelion::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// One requirement and how it went.
struct Requirement {
    std::string id;    ///< for scripts: the option in camel case
    std::string text;  ///< for readers
    double value, limit;
    bool passed;
};

/// The largest |meanA / meanB - 1|; infinite where only meanB is 0.
double meanDifference(const ImageComparison& comparison) {
    double largest = 0;
    for (const ChannelMeans& means : comparison.channels) {
        const double whenBlack = means.meanA == means.meanB ? 0 : kNever;
        largest = std::max(largest, means.ratio ? std::abs(*means.ratio - 1) : whenBlack);
    }
    return largest;
}

/// How far from 1 mean(A) / mean(B) may be, by the intervals of its channels; those take noise to be independent, which
/// identical images refute.
double meanReach(const ImageComparison& comparison) {
    if (comparison.verdict() == ComparisonVerdict::identical) return 0;
    double largest = 0;
    for (const ChannelMeans& means : comparison.channels) {
        const auto [lower, upper] = means.ratioConfidence.value_or(std::array{1.0, 1.0});
        largest = std::max({largest, std::abs(lower - 1), std::abs(upper - 1)});
    }
    return std::max(largest, meanDifference(comparison));
}

/// What the squared error has to be against the noise. Without a noise to divide by, its deviate is 0 or infinite.
Requirement noiseRequirement(const char* id, const char* text, const ImageComparison& comparison, bool twoSided,
                             bool passed) {
    const std::optional<NoiseBudget>& budget = comparison.budget;
    if (!budget) return {id, text, passed ? 0.0 : kNever, twoSidedThreshold(ComparisonOptions{}.significance), passed};
    return {id, text, twoSided ? std::abs(budget->z) : budget->z, budget->threshold, passed};
}

std::vector<Requirement> judge(const CompareArguments& arguments, const ImageComparison& comparison) {
    std::vector<Requirement> requirements;
    const auto require = [&](const char* id, const char* text, double value, const std::optional<double>& limit) {
        if (limit) requirements.push_back({id, text, value, *limit, value <= *limit});
    };
    require("maxMse", "mean squared error", comparison.meanSquaredError, arguments.maxMse);
    require("maxMae", "mean absolute error", comparison.meanAbsoluteError, arguments.maxMae);
    require("maxError", "largest error", comparison.maxAbsoluteError, arguments.maxError);
    require("maxRelmse", "relative mean squared error", comparison.relativeMse, arguments.maxRelativeMse);
    require("maxMeanDifference", "mean difference", meanDifference(comparison), arguments.maxMeanDifference);
    require("meanWithin", "interval of the mean", meanReach(comparison), arguments.meanWithin);
    if (arguments.requireNoiseAlone)
        requirements.push_back(noiseRequirement("noiseAlone", "no more than noise: z of the squared error", comparison,
                                                false, comparison.isNoiseAlone()));
    if (arguments.requireIndependentNoise)
        requirements.push_back(noiseRequirement("independentNoise", "independent noise: |z| of the squared error",
                                                comparison, true, comparison.hasIndependentNoise()));
    if (arguments.requireAgreement)
        requirements.push_back({"agree", "disagreement", comparison.agree() ? 0.0 : 1.0, 0, comparison.agree()});
    // Values left out of the figures cannot be within any limit.
    if (!requirements.empty())
        requirements.push_back({"nonFinite", "values not finite", static_cast<double>(comparison.nonFinite), 0,
                                comparison.nonFinite == 0});
    return requirements;
}

template <typename T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json toJson(const std::optional<LargestDeviation>& deviation) {
    if (!deviation) return nullptr;
    return {{"z", deviation->z},
            {"threshold", deviation->threshold},
            {"channel", deviation->channel},
            {"pixel", {deviation->pixel.x, deviation->pixel.y}},
            {"passed", deviation->passed()}};
}

Json toJson(const std::optional<NoiseBudget>& budget) {
    if (!budget) return nullptr;
    return {{"expectedMse", budget->expected},
            {"ratio", budget->ratio},
            {"ratioConfidence", budget->ratioConfidence},
            {"z", budget->z},
            {"threshold", budget->threshold},
            {"largestBias", budget->largestBias},
            {"level", budget->isMore() ? "more" : (budget->isLess() ? "less" : "independent")}};
}

/// What is not finite in it becomes null.
Json toJson(const ImageComparison& comparison, const std::vector<Requirement>& requirements) {
    Json json = {{"verdict", identifierOf(comparison.verdict())},
                 {"values", comparison.values},
                 {"differing", comparison.differing},
                 {"mse", comparison.meanSquaredError},
                 {"mae", comparison.meanAbsoluteError},
                 {"max", comparison.maxAbsoluteError},
                 {"relmse", comparison.relativeMse},
                 {"relmseEpsilon", comparison.relativeMseEpsilon},
                 {"nonFinite", comparison.nonFinite},
                 {"nonFiniteA", comparison.nonFiniteA},
                 {"nonFiniteB", comparison.nonFiniteB},
                 {"agree", comparison.agree()},
                 {"noise", identifierOf(comparison.noise)},
                 {"channels", Json::array()},
                 {"budget", toJson(comparison.budget)},
                 {"means", toJson(comparison.means)},
                 {"tiles", toJson(comparison.tiles)},
                 {"pixels", toJson(comparison.pixels)},
                 {"requirements", Json::array()}};
    for (const ChannelMeans& means : comparison.channels)
        json["channels"].push_back({{"channel", means.channel},
                                    {"meanA", means.meanA},
                                    {"meanB", means.meanB},
                                    {"ratio", orNull(means.ratio)},
                                    {"ratioConfidence", orNull(means.ratioConfidence)},
                                    {"z", orNull(means.z)}});
    for (const Requirement& requirement : requirements)
        json["requirements"].push_back({{"id", requirement.id},
                                        {"value", requirement.value},
                                        {"limit", requirement.limit},
                                        {"passed", requirement.passed}});
    return json;
}

double meanOfB(const ImageComparison& comparison) {
    double mean = 0;
    for (const ChannelMeans& means : comparison.channels)
        mean += means.meanB / static_cast<double>(comparison.channels.size());
    return mean;
}

/// The differences as a picture: |a - b|, 1 being the mean of b.
Image errorPicture(const Image& error, const ImageComparison& comparison) {
    const double mean = meanOfB(comparison);
    Image picture;
    picture.size = error.size;
    for (const char* channel : {"R", "G", "B"}) {
        std::vector<float>& values = picture.channels[channel] = error.channels.at(fmt::format("error.{}", channel));
        for (float& value : values) value = static_cast<float>(std::abs(value) / (mean > 0 ? mean : 1.0));
    }
    return picture;
}

/// Mean over the three channels of `layer`.
std::vector<float> channelMean(const Image& image, const std::string& layer) {
    std::vector<float> mean(std::size_t(image.size.x) * image.size.y, 0.0f);
    for (const char* channel : {"R", "G", "B"}) {
        const std::vector<float>& values = image.channels.at(fmt::format("{}.{}", layer, channel));
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += values[i] / 3.0f;
    }
    return mean;
}

/// What --pictures asks for. z is the largest in magnitude of a pixel's channels.
void writePictures(const CompareArguments& arguments, const Image& a, const Image& b, const Image& error,
                   const ImageComparison& comparison) {
    const std::string& prefix = arguments.pictures;
    const double mean = meanOfB(comparison);
    writePng(prefix + "_a.png", a);
    writePng(prefix + "_b.png", b);
    writeSignedPng(prefix + "_error.png", error.size, channelMean(error, "error"),
                   arguments.errorRange.value_or(mean > 0 ? 0.1 * mean : 1.0));
    if (!error.has("z.R")) return;
    std::vector<float> z = error.channels.at("z.R");
    for (const char* channel : {"z.G", "z.B"}) {
        const std::vector<float>& other = error.channels.at(channel);
        for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::abs(other[i]) > std::abs(z[i]) ? other[i] : z[i];
    }
    writeSignedPng(prefix + "_z.png", error.size, z, 4.0);
}

struct ErrorFiles {
    fs::path exr, png;
};

std::vector<fs::path> inputsOf(const CompareArguments& arguments) { return {arguments.imageA, arguments.imageB}; }

ErrorFiles prepareErrorFiles(const CompareArguments& arguments) {
    ErrorFiles files{arguments.error, fs::path(arguments.error).replace_extension(".png")};
    if (files.exr.extension() != ".exr")
        throw InputError(fmt::format("--error: expected a name that ends in .exr; got {}", arguments.error));
    for (const fs::path& file : {files.exr, files.png}) {
        refuseReplacing(inputsOf(arguments), file, "--error");
        AtomicFile probe(file);
    }
    return files;
}

void checkPictures(const CompareArguments& arguments) {
    for (const char* suffix : {"_a.png", "_b.png", "_error.png", "_z.png"})
        refuseReplacing(inputsOf(arguments), arguments.pictures + suffix, "--pictures");
}

}  // namespace

int runCompareCommand(const CompareArguments& arguments) {
    Interruption interruption;
    std::optional<ErrorFiles> files;
    if (!arguments.error.empty()) files = prepareErrorFiles(arguments);
    if (!arguments.pictures.empty()) checkPictures(arguments);
    const Image a = readExr(arguments.imageA), b = readExr(arguments.imageB);
    const ComparisonOptions options{.names = {arguments.imageA, arguments.imageB}};
    const ImageComparison comparison = compareImages(a, b, options);
    if (files) {
        const Image error = errorImage(a, b);
        const auto lock = interruption.holdOff();
        writeExr(files->exr, error);
        writePng(files->png, errorPicture(error, comparison));
    }
    if (!arguments.pictures.empty()) {
        const auto lock = interruption.holdOff();
        writePictures(arguments, a, b, errorImage(a, b), comparison);
    }
    const std::vector<Requirement> requirements = judge(arguments, comparison);
    const bool passed = std::ranges::all_of(requirements, &Requirement::passed);
    if (arguments.json) {
        printJson(toJson(comparison, requirements));
        return passed ? kExitSuccess : kExitFailed;
    }
    fmt::print("{}", describe(comparison));
    for (const Requirement& requirement : requirements)
        fmt::print("{}  {} {:.6g}, allowed {:.6g}\n", requirement.passed ? "passed" : "FAILED", requirement.text,
                   requirement.value, requirement.limit);
    return passed ? kExitSuccess : kExitFailed;
}

}  // namespace parhelion::app
