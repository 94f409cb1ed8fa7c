#include "app/effect_names.h"

#include <fmt/format.h>

namespace parhelion::app {

std::string effectsKey(const EffectSet& effects) {
    std::string key;
    for (unsigned effect = 0; effect < kEffectCount; ++effect)
        if (effects.on[effect]) key += fmt::format("{}{}", key.empty() ? "" : " ", kEffectNames[effect].identifier);
    return key;
}

std::string qualityKey(const Quality& quality) {
    std::string key;
#define X(name, id, type, value, label) key += fmt::format("{}" #name "={}", key.empty() ? "" : " ", quality.name);
    PARHELION_QUALITY(X)
#undef X
    return key;
}

}  // namespace parhelion::app
