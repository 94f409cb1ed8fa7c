#pragma once

#include "compile/compiled_scene.h"
#include "render/device_scene.h"
#include "render/specialise.h"
#include "support/gpu_fixture.h"

namespace parhelion::test {

/// A scene on the device, for the functions that read one.
class SceneProbe {
public:
    /// Every effect is on, but for the storage of densities, which has to be the scene's.
    explicit SceneProbe(const CompiledScene& scene, const Quality& quality = {})
        : device_(testDevice(), scene), constants_(render::specialise(scene, effectsOf(scene), quality)) {}

    /// See probe().
    std::vector<glm::vec4> run(const std::filesystem::path& shader, std::uint32_t function,
                               std::span<const glm::vec4> inputs, std::uint32_t inputsPerItem = 1,
                               std::uint32_t outputsPerItem = 1) const {
        return probe(shader, function, inputs, inputsPerItem, outputsPerItem, constants_, device_.bindings());
    }

private:
    static EffectSet effectsOf(const CompiledScene& scene) {
        EffectSet effects = EffectSet::all();
        effects.on[static_cast<unsigned>(Effect::hasBrickedDensity)] = !scene.brickTable.empty();
        return effects;
    }

    render::DeviceScene device_;
    gpu::Specialisation constants_;
};

}  // namespace parhelion::test
