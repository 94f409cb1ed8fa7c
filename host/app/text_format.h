#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace parhelion::app {

/// Prints to standard output. Bytes that are no UTF-8, which names of files may have, become replacement characters.
void printJson(const nlohmann::ordered_json& json);

/// "950", "12.3 k", "4.56 M", "7.89 G": three significant digits.
std::string formatCount(double count);
/// "512 B", "1.50 KiB", "2.25 GiB".
std::string formatBytes(double bytes);
/// "0.25 s", "12.3 s", "3 min 05 s", "2 h 07 min".
std::string formatDuration(double seconds);
/// "3.1 %": a fraction as per cent, two significant digits.
std::string formatPercent(double fraction);
/// "640x480"
std::string formatSize(glm::uvec2 size);
/// "64x64x32"
std::string formatSize(glm::uvec3 size);
/// "0.5, 0.25, 1": shortest exact text of each.
std::string formatColor(glm::vec3 color);

}  // namespace parhelion::app
