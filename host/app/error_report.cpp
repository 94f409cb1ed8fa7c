#include "app/error_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/text_format.h"

namespace parhelion::app {

namespace {

constexpr const char* kChannels[] = {"R", "G", "B", "Y"};

/// JSON has no infinity.
nlohmann::ordered_json number(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json toJson(const Interval& interval) {
    return {{"value", number(interval.value)}, {"lower", number(interval.lower)}, {"upper", number(interval.upper)}};
}

template <typename Number>
nlohmann::ordered_json orNull(const std::optional<Number>& value) {
    return value ? number(static_cast<double>(*value)) : nlohmann::ordered_json(nullptr);
}

const char* nameOf(TrustCheck::Verdict verdict) {
    switch (verdict) {
        case TrustCheck::Verdict::Passed:
            return "passed";
        case TrustCheck::Verdict::Failed:
            return "failed";
        case TrustCheck::Verdict::NotJudged:
            return "notJudged";
    }
    return "";
}

nlohmann::ordered_json toJson(const FilmError& error) {
    nlohmann::ordered_json json = {{"finite", error.isFinite},
                                   {"rms", toJson(error.rms)},
                                   {"relmse", toJson(error.relativeMse)},
                                   {"mean", nlohmann::ordered_json::object()},
                                   {"pixels", nlohmann::ordered_json::object()},
                                   {"varianceOfVariance", number(error.varianceOfVariance)},
                                   {"largestOnceMore", number(error.largestOnceMore)},
                                   {"tailSlope", number(error.tailSlope)}};
    for (std::size_t c = 0; c < 4; ++c) json["mean"][kChannels[c]] = toJson(error.mean[c]);
    json["pixels"] = {{"q50", number(error.pixels[0])},          {"q95", number(error.pixels[1])},
                      {"q99", number(error.pixels[2])},          {"within1Percent", number(error.pixelsWithin)},
                      {"trusted", number(error.pixelsTrusted)},  {"dark", number(error.pixelsDark)},
                      {"notTrusted", number(error.pixelsSpiky)}, {"worst95", number(error.worstPixels)}};
    return json;
}

std::string describeTarget(const ErrorReport& report) {
    if (!report.target) return "";
    const bool isKnown = report.controlError && std::isfinite(*report.controlError);
    const bool isReached = isKnown && *report.controlError <= *report.target;
    std::string text = fmt::format("target    {} ({}): {}reached, {}", formatPercent(*report.target),
                                   nameOf(report.norm), isReached ? "" : "not ",
                                   isKnown ? formatPercent(*report.controlError) + " by the control pixels"
                                           : "the error of the control pixels is not known");
    if (!isReached && report.samplesForTarget && report.secondsForTarget)
        text += fmt::format("; it would take {} samples per pixel, {}", formatCount(*report.samplesForTarget),
                            formatDuration(*report.secondsForTarget));
    return text + "\n";
}

}  // namespace

nlohmann::ordered_json toJson(const ErrorReport& report) {
    nlohmann::ordered_json json = {{"norm", nameOf(report.norm)},
                                   {"target", orNull(report.target)},
                                   {"timeLimitSeconds", orNull(report.seconds)},
                                   {"maximumSamples", orNull(report.maximum)},
                                   {"trusted", report.isTrusted()},
                                   {"controlError", orNull(report.controlError)},
                                   {"samplesForTarget", orNull(report.samplesForTarget)},
                                   {"secondsForTarget", orNull(report.secondsForTarget)},
                                   {"samplesForHalf", orNull(report.samplesForHalf)},
                                   {"secondsForHalf", orNull(report.secondsForHalf)},
                                   {"estimate", nullptr},
                                   {"checks", nlohmann::ordered_json::array()},
                                   {"checkpoints", nlohmann::ordered_json::array()}};
    if (report.estimate) json["estimate"] = toJson(*report.estimate);
    for (const TrustCheck& check : report.checks)
        json["checks"].push_back({{"name", check.name},
                                  {"found", check.found},
                                  {"wanted", check.wanted},
                                  {"verdict", nameOf(check.verdict)}});
    for (const ErrorCheckpoint& point : report.checkpoints)
        json["checkpoints"].push_back({{"samples", point.samples},
                                       {"seconds", point.seconds},
                                       {"error", number(point.error)},
                                       {"mean", number(point.mean)},
                                       {"meanError", number(point.meanError)},
                                       {"varianceOfVariance", number(point.varianceOfVariance)}});
    return json;
}

std::string describe(const ErrorReport& report) {
    if (!report.estimate) return "error     unknown: one sample a pixel, or a black image\n" + describeTarget(report);
    const FilmError& error = *report.estimate;
    if (!error.isFinite) return "error     unknown: sums beyond single precision\n";
    std::string text =
        fmt::format("error     {} of the image's mean (rms; 95 %: {} to {})\n", formatPercent(error.rms.value),
                    formatPercent(error.rms.lower), formatPercent(error.rms.upper));
    text += fmt::format("mean      {:.5g} +- {} (luminance, 95 %)\n", error.mean[3].value,
                        formatPercent(error.meanRelative()));
    if (error.pixelsTrusted > 0)
        text += fmt::format("pixels    half within {}, 95 % within {} of themselves; {} are known to 1 %\n",
                            formatPercent(error.pixels[0]), formatPercent(error.pixels[1]),
                            formatPercent(error.pixelsWithin));
    if (error.pixelsSpiky > 0.005)
        text += fmt::format("unknown   {} of the pixels: their samples are too few and uneven for an interval\n",
                            formatPercent(error.pixelsSpiky));
    if (error.pixelsDark > 0.005)
        text += fmt::format("dark      {} of the pixels got nothing but zeros\n", formatPercent(error.pixelsDark));
    std::string failed;
    for (const TrustCheck& check : report.checks)
        if (check.verdict == TrustCheck::Verdict::Failed)
            failed +=
                fmt::format("{}{}: {} (wanted {})", failed.empty() ? "" : "; ", check.name, check.found, check.wanted);
    if (!report.target && report.samplesForHalf && report.secondsForHalf)
        text += fmt::format("cleaner   half of that error takes {} samples per pixel, {} in all\n",
                            formatCount(*report.samplesForHalf), formatDuration(*report.secondsForHalf));
    if (!failed.empty()) text += "trust     not yet: " + failed + "\n";
    return text + describeTarget(report);
}

void addAttributes(const ErrorReport& report, Image& image) {
    auto& attributes = image.attributes;
    if (!report.estimate || !report.estimate->isFinite) return;
    const FilmError& error = *report.estimate;
    attributes["parhelion.error"] = error.rms.value;
    attributes["parhelion.errorLower"] = error.rms.lower;
    attributes["parhelion.errorUpper"] = error.rms.upper;
    attributes["parhelion.relmse"] = error.relativeMse.value;
    attributes["parhelion.meanError"] = error.meanRelative();
    attributes["parhelion.pixelsWithin1Percent"] = error.pixelsWithin;
    attributes["parhelion.pixelsTrusted"] = error.pixelsTrusted;
    attributes["parhelion.errorTrusted"] = std::int64_t{report.isTrusted()};
}

void addErrorLayers(Image& image, const Film& film) {
    if (film.samples < 2) return;
    PixelErrors errors = estimatePixelErrors(film);
    image.channels["error.Y"] = std::move(errors.halfWidth);
    image.channels["trust.Y"] = std::move(errors.isTrusted);
}

}  // namespace parhelion::app
