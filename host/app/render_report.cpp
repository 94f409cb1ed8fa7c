#include "app/render_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/cloud_reports.h"
#include "app/effect_names.h"
#include "app/text_format.h"
#include "base/files.h"

namespace parhelion::app {

namespace {

struct CounterName {
    std::uint32_t counter;
    const char* identifier;
    const char* meaning;
};

constexpr CounterName kCounterNames[] = {
    {shared::kCounterNonFinite, "nonFinite", "samples dropped because not finite, or beyond single precision"},
    {shared::kCounterMajorantViolations, "majorantViolations", "densities above their majorant"},
    {shared::kCounterNegative, "negative", "samples with a negative channel"},
    {shared::kCounterPathsFinished, "pathsFinished", "paths"},
    {shared::kCounterVertices, "vertices", "scatterings"},
    {shared::kCounterCollisions, "collisions", "tentative collisions"},
    {shared::kCounterSteps, "steps", "tracking steps"},
};

}  // namespace

double RenderReport::samplesPerSecond() const {
    const double taken = samplesPerPixel * cropSize.x * cropSize.y;
    return seconds > 0 ? taken / seconds : 0;
}

bool RenderReport::hasAnomalies() const {
    return counters[shared::kCounterNonFinite] > 0 || counters[shared::kCounterMajorantViolations] > 0 || range.any();
}

void addAttributes(const RenderReport& report, Image& image) {
    auto& attributes = image.attributes;
    const auto samples = static_cast<std::int64_t>(report.samples);
    attributes["samplesPerPixel"] = samples;
    attributes["renderTimeSeconds"] = report.seconds;
    attributes["parhelion.version"] = std::string(PARHELION_VERSION);
    attributes["parhelion.scene"] = report.scene;
    attributes["parhelion.backend"] = report.backend;
    attributes["parhelion.device"] = report.device;
    attributes["parhelion.driver"] = report.driver;
    attributes["parhelion.samples"] = samples;
    attributes["parhelion.seed"] = static_cast<std::int64_t>(report.seed);
    attributes["parhelion.seconds"] = report.seconds;
    attributes["parhelion.effects"] = effectsKey(report.effects);
    attributes["parhelion.quality"] = qualityKey(report.quality);
    for (const auto& [counter, identifier, meaning] : kCounterNames)
        attributes[fmt::format("parhelion.{}", identifier)] = static_cast<std::int64_t>(report.counters[counter]);
    addAttributes(report.error, image);
    attributes["parhelion.endedBy"] = std::string(nameOf(report.endedBy));
    attributes["parhelion.aboveRange"] = static_cast<std::int64_t>(report.range.above);
    attributes["parhelion.belowRange"] = static_cast<std::int64_t>(report.range.below);
}

nlohmann::ordered_json toJson(const RenderReport& report) {
    nlohmann::ordered_json json = {
        {"version", PARHELION_VERSION},
        {"scene", report.scene},
        {"exr", report.exr},
        {"png", report.png},
        {"backend", report.backend},
        {"device", report.device},
        {"driver", report.driver},
        {"filmSize", {report.filmSize.x, report.filmSize.y}},
        {"cropOffset", {report.cropOffset.x, report.cropOffset.y}},
        {"cropSize", {report.cropSize.x, report.cropSize.y}},
        {"samples", report.samples},
        {"samplesWanted", report.samplesWanted},
        {"interrupted", report.interrupted()},
        {"seed", report.seed},
        {"prepareSeconds", report.prepareSeconds},
        {"seconds", report.seconds},
        {"samplesPerSecond", report.samplesPerSecond()},
        {"samplesPerPixel", report.samplesPerPixel},
        {"endedBy", nameOf(report.endedBy)},
        {"relativeError", nullptr},
        {"error", toJson(report.error)},
        {"effects", effectsKey(report.effects)},
        {"quality", qualityKey(report.quality)},
        {"anomalies", report.hasAnomalies()},
        {"counters", nlohmann::ordered_json::object()},
        {"clouds", toJson(report.clouds)},
        {"notes", report.notes},
    };
    if (report.error.estimate && report.error.estimate->isFinite)
        json["relativeError"] = report.error.estimate->rms.value;
    for (const auto& [counter, identifier, meaning] : kCounterNames)
        json["counters"][identifier] = report.counters[counter];
    json["counters"]["aboveRange"] = report.range.above;
    json["counters"]["belowRange"] = report.range.below;
    return json;
}

std::string describe(const RenderReport& report) {
    std::string text;
    if (report.interrupted())
        text += fmt::format("interrupted after {} of {} samples per pixel\n", report.samples, report.samplesWanted);
    text += fmt::format("image     {}\nview      {}\n", report.exr, report.png);
    text += fmt::format("device    {} ({})\n", report.device, report.driver);
    text += fmt::format("time      {} rendering, {} preparing\n", formatDuration(report.seconds),
                        formatDuration(report.prepareSeconds));
    text += fmt::format("samples   {:.6g} per pixel, {} samples/s; ended by {}\n", report.samplesPerPixel,
                        formatCount(report.samplesPerSecond()), nameOf(report.endedBy));
    text += describe(report.clouds);
    text += describe(report.error);
    for (const auto& [counter, identifier, meaning] : kCounterNames)
        if (report.counters[counter] > 0)
            text +=
                fmt::format("counted   {} {}\n", formatCount(static_cast<double>(report.counters[counter])), meaning);
    if (report.range.above > 0)
        text += fmt::format("counted   {} values of the image beyond single precision, written as 3.4e38\n",
                            formatCount(static_cast<double>(report.range.above)));
    if (report.range.below > 0)
        text +=
            fmt::format("counted   {} means or variances too small for single precision; variances are bounds there\n",
                        formatCount(static_cast<double>(report.range.below)));
    return text;
}

void writeErrorReport(const RenderReport& report, const std::filesystem::path& file) {
    const bool isPage = file.extension() == ".html";
    const std::string text =
        isPage ? errorPage(report)
               : toJson(report).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    writeAtomically(file, text);
}

}  // namespace parhelion::app
