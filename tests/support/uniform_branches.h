#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gpu/pipeline.h"

namespace parhelion::test {

/// Where a kernel decides by what Mesa 22's software driver takes for constants: branches, switches and loop limits
/// that depend on nothing but words at constant offsets of uniform blocks or push constants, and such words kept in
/// arrays. It compiles a kernel that has one again at every submission, and never frees what it compiled.
///
/// The module is specialised, inlined and optimised as the driver does it, by SPIRV-Tools. What cannot be followed (a
/// function left uninlined) is reported as well. Rules of the driver: Mesa 22.3, `lvp_find_inlinable_uniforms` and
/// `nir_collect_src_uniforms`.
///
/// @param constants  specialisation constants by constant_id; the others keep their defaults.
/// @return a line for each: what decides, and the words it depends on by name. Empty: none.
/// @throws std::runtime_error for a module that SPIRV-Tools refuses.
std::vector<std::string> uniformDecisions(std::span<const std::uint32_t> spirv,
                                          const gpu::Specialisation& constants = {});

}  // namespace parhelion::test
