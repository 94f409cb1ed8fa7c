#pragma once

#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "support/temporary_folder.h"

namespace parhelion::test {

/// A compiled scene and what it is good for.
struct NamedScene {
    std::string name;
    CompiledScene scene;
};

/// Small scenes that together call for every effect of shaders/shared/effects.h, each for other combinations.
///
/// @param folder  where their mesh and volume files are written.
std::vector<NamedScene> effectScenes(const TemporaryFolder& folder, glm::uvec2 size);

/// Keeps the density grids as bricks, which compileScene does for large sparse ones only.
void storeAsBricks(CompiledScene& scene);

}  // namespace parhelion::test
