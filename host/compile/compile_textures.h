#pragma once

#include <span>

#include "compile/compile_geometry.h"

namespace parhelion {

/// Writes the textures that shapes and lights use, each once, and tells the shapes where they went.
///
/// A texture of one colour becomes that colour. Reflectances above 1 (texel or checker colour, times the tint) are
/// simulated as they are, as Mitsuba does, and noted with their number; not in paths without a depth limit, which
/// need not end then.
/// @param shapes  receives `reflectance` and `radiance`.
/// @param scene   receives textures, texels and notes; its depth limit must be set.
/// @throws InputError for reflectances above 1 on unlimited paths, transforms beyond float, and more texels than a
///         buffer can hold.
void compileTextures(const SceneDescription& description, std::span<KeptShape> shapes, CompiledScene& scene);

}  // namespace parhelion
