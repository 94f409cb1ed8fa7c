#include "app/cloud_reports.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/text_format.h"
#include "reference/cloud_baker.h"
#include "render/bake_cloud.h"

namespace parhelion::app {

namespace {

nlohmann::ordered_json toJson(const CloudBakeReport& report) {
    nlohmann::ordered_json json = {{"where", report.where},
                                   {"resolution", {report.resolution.x, report.resolution.y, report.resolution.z}},
                                   {"modulates", report.modulates},
                                   {"seconds", report.seconds},
                                   {"meanDensity", report.meanDensity},
                                   {"occupancy", report.occupancy},
                                   {"massRatio", nullptr},
                                   {"error", nullptr}};
    if (report.modulates) json["massRatio"] = report.massRatio;
    if (report.error)
        json["error"] = {{"doubledRms", report.error->doubledRms},
                         {"doubledMaximum", report.error->doubledMaximum},
                         {"fieldRms", report.error->fieldRms},
                         {"fieldMaximum", report.error->fieldMaximum},
                         {"points", report.error->points}};
    return json;
}

std::string describe(const CloudBakeReport& report) {
    const glm::uvec3 n = report.resolution;
    std::string text = fmt::format("cloud     {}x{}x{} voxels baked in {}, {} of them occupied", n.x, n.y, n.z,
                                   formatDuration(report.seconds), formatPercent(report.occupancy));
    if (report.modulates) text += fmt::format(", mass kept to {:.2g}", std::abs(report.massRatio - 1));
    if (report.error)
        text += fmt::format(
            "\n          baked at twice the resolution it differs by {:.2g} (rms) and {:.2g} at most;\n"
            "          the field itself, at {} random points, by {:.2g} (rms) and {:.2g} at most",
            report.error->doubledRms, report.error->doubledMaximum, report.error->points, report.error->fieldRms,
            report.error->fieldMaximum);
    return text + "\n";
}

}  // namespace

CloudBaker deviceBaker(gpu::Device& device) {
    return {.bake = [&device](const shared::CloudField& field, std::span<const float> base,
                              float largest) { return render::bakeCloud(device, field, base, largest); },
            .evaluate = reference::cloudDensityAt};
}

CloudBaker twinBaker() { return {.bake = reference::bakeCloud<float>, .evaluate = reference::cloudDensityAt}; }

nlohmann::ordered_json toJson(std::span<const CloudBakeReport> reports) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const CloudBakeReport& report : reports) array.push_back(toJson(report));
    return array;
}

std::string describe(std::span<const CloudBakeReport> reports) {
    std::string text;
    for (const CloudBakeReport& report : reports) text += describe(report);
    return text;
}

}  // namespace parhelion::app
