#pragma once

#include <map>
#include <string>

#include "scene/scene_description.h"
#include "support/temporary_folder.h"

namespace parhelion::test {

/// The parts a scene cannot do without, on one line.
inline const std::string kIntegrator = R"(<integrator type="volpath"/>)";
inline const std::string kSensor = R"(<sensor type="perspective"/>)";

/// A scene of the given parts; the body starts on line 2.
inline std::string sceneOf(const std::string& body, const std::string& rest = kIntegrator + kSensor) {
    return "<scene version=\"3.0.0\">\n" + body + "\n" + rest + "\n</scene>\n";
}

/// Reads a scene from text, other files beside it or in folders below.
inline SceneDescription readText(const std::string& text, const SceneReadOptions& options = {},
                                 const std::map<std::string, std::string>& files = {}) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : files) {
        std::filesystem::create_directories((folder.path() / name).parent_path());
        folder.write(name, content);
    }
    return readScene(folder.write("scene.xml", text), options);
}

}  // namespace parhelion::test
