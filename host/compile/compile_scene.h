#pragma once

#include <optional>

#include "compile/compiled_scene.h"
#include "scene/scene_description.h"

namespace parhelion {

struct CompileOptions {
    std::optional<glm::uvec2> size;  ///< --size
    std::optional<glm::uvec2> cropOffset, cropSize;
    std::optional<std::int64_t> maxDepth;  ///< --max-depth
    std::optional<unsigned> depthLayers;   ///< --depth-layers
    bool sampleEveryLight = false;         ///< next-event estimation for environments of low contrast too
    std::size_t memoryLimitBytes = 0;      ///< refuse larger scenes; 0: half of the machine's memory
};

/// Canonicalises and flattens a description: black lights and empty media are dropped, lights get
/// selection probabilities, grids their majorants, meshes a BVH; positions are made relative to the
/// camera in double precision.
/// @throws InputError naming the scene element for what cannot be simulated (overlapping media, singular transforms,
/// ...).
CompiledScene compileScene(const SceneDescription& description, const CompileOptions& options = {});

/// Which effects `scene` calls for, and why (called by compileScene; exposed for tests).
EffectSet analyseEffects(const CompiledScene& scene);

}  // namespace parhelion
