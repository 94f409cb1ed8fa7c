#pragma once

#include <cstdint>
#include <filesystem>

namespace parhelion::test {

/// Compares maps with a table of tools/mitsuba/environment_maps.py: the shader's radiance, and the double reference's.
///
/// Mitsuba computes in single precision: its u = atan2 / 2 pi and v = acos / pi are off by roundings, which a steep map
/// turns into more than 1e-5 of the radiance. Allowed is 1e-5 and what some roundings of the direction, of its cosine
/// and of u and v explain, by the definition in double.
/// @param folder  of the maps that are files.
void expectTableAgrees(const std::filesystem::path& table, const std::filesystem::path& folder,
                       const std::filesystem::path& shader, std::uint32_t function);

}  // namespace parhelion::test
