#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/pipeline.h"

namespace parhelion::test {

/// The device of this test process, validation on; opened on first use. The run fails at its end if the validation
/// layer said anything, closing the device included.
gpu::Device& testDevice();

/// Hands over what the validation layer said so far, for tests that provoke it; the run no longer fails for that.
std::vector<std::string> takeValidationMessages();

/// Runs `function` of a parity shader (tests/support/probe.glsl says what that is) on every row of inputs.
///
/// @param shader      path below tests/, e.g. "parity/math.comp".
/// @param function    the shader's probeFunction.
/// @param inputs      inputsPerItem values for each item, item by item.
/// @param constants   specialisation constants.
/// @param extra       resources the modules under test need, at their own bindings (not 30 or 31).
/// @return outputsPerItem values for each item, item by item; zero where the shader wrote none.
std::vector<glm::vec4> probe(const std::filesystem::path& shader, std::uint32_t function,
                             std::span<const glm::vec4> inputs, std::uint32_t inputsPerItem = 1,
                             std::uint32_t outputsPerItem = 1, const gpu::Specialisation& constants = {},
                             std::span<const gpu::Binding> extra = {});

}  // namespace parhelion::test
