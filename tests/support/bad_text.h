#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "support/scene_reading.h"

namespace parhelion::test {

/// A scene that must be refused. "@@" in one of the texts marks the character that the message must blame; without a
/// mark it must blame the file besides scene.xml as a whole.
struct BadText {
    std::string name;
    std::string text;                   ///< scene.xml
    std::vector<std::string> mentions;  ///< what the message must say
    std::map<std::string, std::string> files = {};

    friend void PrintTo(const BadText& bad, std::ostream* stream) { *stream << bad.name; }
};

/// Names a case of a suite over BadText.
inline const auto nameOfBadText = [](const auto& info) { return info.param.name; };

/// Reads the scene and fails the test unless an InputError names the place and says what `mentions` lists.
void expectRefused(BadText bad);

// Scenes around the part that is wrong, which starts line 3 unless said otherwise.
std::string sphereOf(const std::string& content);
std::string diffuseOf(const std::string& content);
std::string mediumOf(const std::string& content, const std::string& type = "homogeneous");
std::string gridOf(const std::string& content);    ///< a heterogeneous medium's sigma_t
std::string cameraOf(const std::string& content);  ///< line 4
std::string filmOf(const std::string& content);    ///< line 4
std::string integratorOf(const std::string& content);

}  // namespace parhelion::test
