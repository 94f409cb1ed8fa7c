#pragma once

#include "scene/nori_grammar.h"
#include "scene/scene_description.h"

namespace parhelion {

/// Reads a scene in Nori's dialect, with the plugins of the baseline (scenes/README.md, "Nori dialect").
///
/// @param root  the file as it was read.
/// @throws InputError with file:line:column for anything malformed, unknown or unsupported, naming what is allowed.
SceneDescription readNoriScene(const std::filesystem::path& file, XmlElement root, const SceneReadOptions& options);

}  // namespace parhelion
