#include "support/environment_table.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <fstream>
#include <map>
#include <sstream>

#include "reference/light/environment.h"
#include "support/environment_maps.h"
#include "support/hand_scene.h"
#include "support/scene_probe.h"

namespace parhelion::test {

namespace {

struct Row {
    glm::vec3 direction;
    glm::dvec3 radiance;
};
/// Name of the map and rotation.
using Setting = std::pair<std::string, std::array<double, 4>>;

std::map<Setting, std::vector<Row>> readTable(const std::filesystem::path& file) {
    std::map<Setting, std::vector<Row>> table;
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
        std::istringstream cells(line);
        Setting setting;
        std::getline(cells, setting.first, ',');
        std::array<double, 10> values{};
        std::string cell;
        for (double& value : values) {
            std::getline(cells, cell, ',');
            value = std::stod(cell);
        }
        std::copy_n(values.begin(), 4, setting.second.begin());
        table[setting].push_back({glm::vec3(values[4], values[5], values[6]), {values[7], values[8], values[9]}});
    }
    return table;
}

EmitterDescription mapOf(const Setting& setting, const std::filesystem::path& folder) {
    EmitterDescription emitter;
    if (unsigned width = 0, height = 0; std::sscanf(setting.first.c_str(), "%ux%u", &width, &height) == 2)
        emitter = madeMap({width, height});
    else
        emitter.map = readBitmap(folder / setting.first, {});
    emitter.type = EmitterDescription::Type::EnvironmentMap;
    const auto& [x, y, z, degrees] = setting.second;
    emitter.toWorld = rotationMatrix({x, y, z}, degrees);
    return emitter;
}

/// What Mitsuba's roundings allow. acos has the slope 1 / sin, and at the poles a rounding of 1 is an angle of 3e-4.
ColourRange allowedRange(const EmitterDescription& map, const glm::dvec3& direction) {
    constexpr double kStep = 8 * 0x1p-24, kPi = std::numbers::pi;
    const MapPoint p = mapPoint(map, direction);
    const double du = p.sine > 0 ? kStep * (1 + 0.5 / (kPi * p.sine)) : 0.5;
    const double dv = std::min(p.sine > 0 ? kStep * (1 + 1 / (kPi * p.sine)) : 1.0, std::sqrt(2 * kStep) / kPi + kStep);
    return mapRange(map, p, std::min(du, 0.5), dv);
}

bool within(const glm::dvec3& value, const ColourRange& range) {
    bool holds = true;
    for (int c = 0; c < 3; ++c)
        holds = holds && value[c] >= range.low[c] * (1 - 1e-5) && value[c] <= range.high[c] * (1 + 1e-5);
    return holds;
}

double relativeError(const glm::dvec3& value, const glm::dvec3& expected) {
    const glm::dvec3 error = glm::abs(value - expected) / glm::max(glm::abs(expected), 1e-30);
    return std::max({error.x, error.y, error.z});
}

}  // namespace

void expectTableAgrees(const std::filesystem::path& table, const std::filesystem::path& folder,
                       const std::filesystem::path& shader, std::uint32_t function) {
    std::size_t total = 0, close = 0, mitsubaClose = 0;
    for (const auto& [setting, rows] : readTable(table)) {
        const EmitterDescription map = mapOf(setting, folder);
        if (map.map.size == glm::uvec2(1)) continue;  // a constant emitter
        HandScene scene;
        scene.setEnvironmentMap(map);
        const reference::SceneView<double> view(scene.scene);
        std::vector<glm::vec4> inputs;
        for (const Row& row : rows) inputs.emplace_back(row.direction, 0);
        const auto outputs = SceneProbe(scene.scene).run(shader, function, inputs);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const glm::dvec3 direction(rows[i].direction);
            const ColourRange range = allowedRange(map, direction);
            const glm::dvec3 exact = reference::environmentAt(view, direction).radiance;
            EXPECT_TRUE(within(rows[i].radiance, range)) << setting.first << ", direction " << i << ": Mitsuba differs";
            EXPECT_TRUE(within(exact, range)) << setting.first << ", direction " << i << ": the reference differs";
            EXPECT_TRUE(within(glm::dvec3(outputs[i]), range)) << setting.first << ", direction " << i;
            ++total;
            close += relativeError(glm::dvec3(outputs[i]), exact) <= 1e-5;
            mitsubaClose += relativeError(rows[i].radiance, exact) <= 1e-5;
        }
    }
    EXPECT_GT(total, 0u) << table << " is missing or empty";
    std::printf("%zu directions; within 1e-5 of double precision: Mitsuba %.2f %%, the shader %.2f %%\n", total,
                100.0 * double(mitsubaClose) / double(total), 100.0 * double(close) / double(total));
}

}  // namespace parhelion::test
