#include "app/text_format.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

namespace parhelion::app {

namespace {

/// Divides by `base` until below it, and names the step reached.
std::string scaled(double value, double base, std::span<const char* const> units) {
    std::size_t step = 0;
    while (value >= base && step + 1 < units.size()) {
        value /= base;
        ++step;
    }
    if (step == 0) return fmt::format("{:.0f}{}", value, units[0]);
    return fmt::format("{:.{}f}{}", value, value < 10 ? 2 : value < 100 ? 1 : 0, units[step]);
}

}  // namespace

void printJson(const nlohmann::ordered_json& json) {
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string formatCount(double count) {
    static constexpr std::array kUnits{"", " k", " M", " G", " T"};
    return scaled(count, 1000, kUnits);
}

std::string formatBytes(double bytes) {
    static constexpr std::array kUnits{" B", " KiB", " MiB", " GiB", " TiB"};
    return scaled(bytes, 1024, kUnits);
}

std::string formatDuration(double seconds) {
    if (!std::isfinite(seconds) || seconds > 1e9) return "unknown time";
    if (seconds < 9.995) return fmt::format("{:.2f} s", seconds);
    if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(std::llround(seconds));
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string formatPercent(double fraction) {
    const double percent = 100 * fraction;
    return percent >= 10 ? fmt::format("{:.0f} %", percent) : fmt::format("{:.2g} %", percent);
}

std::string formatSize(glm::uvec2 size) { return fmt::format("{}x{}", size.x, size.y); }

std::string formatSize(glm::uvec3 size) { return fmt::format("{}x{}x{}", size.x, size.y, size.z); }

std::string formatColor(glm::vec3 color) { return fmt::format("{}, {}, {}", color.x, color.y, color.z); }

}  // namespace parhelion::app
