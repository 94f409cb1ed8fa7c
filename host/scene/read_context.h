#pragma once

#include <fmt/format.h>

#include <map>
#include <set>
#include <string_view>

#include "scene/property_reader.h"
#include "scene/scene_description.h"

namespace parhelion {

/// What the readers of the parts share while one scene is read.
struct ReadContext {
    const SceneTree& tree;
    const SceneReadOptions& options;
    SceneDescription& scene;
    std::map<const XmlElement*, std::size_t> mediumIndices;  ///< of the media read so far
    std::set<const XmlElement*> volumesRead;
    std::map<const XmlElement*, std::size_t> textureIndices = {};  ///< of the textures read so far
    std::vector<const XmlElement*> namedMedia = {};                ///< by emitters, to no effect

    /// Tells the user of something that was accepted but has no effect.
    void note(const SourceLocation& where, std::string_view text) {
        scene.notes.push_back(fmt::format("{}: {}", where.text(), text));
    }

    /// The same of several things that are located already.
    void note(const std::vector<std::string>& located) {
        scene.notes.insert(scene.notes.end(), located.begin(), located.end());
    }
};

}  // namespace parhelion
