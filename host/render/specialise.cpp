#include "render/specialise.h"

#include "shared/sizes.h"

namespace parhelion::render {

gpu::Specialisation specialise(const CompiledScene& scene, const EffectSet& effects, const Quality& quality) {
    gpu::Specialisation constants;
#define X(name, id, label) constants[id] = effects.has(Effect::name);
    PARHELION_EFFECTS(X)
#undef X
#define X(name, id, type, value, label) constants[id] = quality.name;
    PARHELION_QUALITY(X)
#undef X
    const shared::SceneConstants& counts = scene.constants;
    const std::uint32_t quadCount = counts.quadCount, sphereCount = counts.sphereCount, boxCount = counts.boxCount;
    const auto shapeCount = static_cast<std::uint32_t>(scene.shapes.size());
#define X(name, id) constants[id] = name;
    PARHELION_SIZES(X)
#undef X
    return constants;
}

}  // namespace parhelion::render
