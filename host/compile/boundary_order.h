#pragma once

#include <cstdint>
#include <vector>

#include "compile/compiled_scene.h"

namespace parhelion {

/// Numbers the medium boundaries from 1 on so that those within one follow it without a gap: whether one surrounds
/// another is then a comparison, however deep they are nested.
///
/// @return for each shape of the scene what its flags get on the device: its number at kShapeOrderShift and the last
///         number within it at kShapeLastShift, or 0 for what is no boundary.
/// @throws RuntimeFailure for more than kMaxBoundaries of them; compileScene refuses such scenes, with a place.
std::vector<std::uint32_t> orderBoundaries(const CompiledScene& scene);

}  // namespace parhelion
