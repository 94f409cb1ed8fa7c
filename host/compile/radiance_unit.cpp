#include "compile/radiance_unit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parhelion {

namespace {

/// What a point light may be brighter by, near it, than at the scene's far end. Even 2^-40 of the unit squares to
/// 2^-80, far from what floats lose (2^-126).
constexpr double kNearerBy = 0x1p40;

double largestOf(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

double brightnessOf(const EmitterDescription& emitter, double sceneRadius) {
    using Type = EmitterDescription::Type;
    switch (emitter.type) {
        case Type::Sky:
            return largestOf(glm::max(emitter.sky.bottom, emitter.sky.top) +
                             (emitter.sky.starDensity > 0.0 ? emitter.sky.starRadiance : glm::dvec3(0.0)));
        case Type::EnvironmentMap: {
            glm::vec3 largest(0.0f);
            for (const glm::vec3& texel : emitter.map.texels) largest = glm::max(largest, texel);
            return largestOf(glm::dvec3(largest) * emitter.value);
        }
        case Type::Point: {
            const double atFarEnd = largestOf(emitter.value) / (sceneRadius * sceneRadius);
            return std::clamp(1.0, atFarEnd, kNearerBy * atFarEnd);
        }
        case Type::Directional:
        case Type::Constant:
            break;
    }
    return largestOf(emitter.value);
}

}  // namespace

double chooseRadianceUnit(const SceneDescription& description, std::span<const KeptShape> shapes, double sceneRadius) {
    double brightest = 0.0;
    for (const EmitterDescription& emitter : description.emitters)
        brightest = std::max(brightest, brightnessOf(emitter, sceneRadius));
    for (const KeptShape& shape : shapes)
        if (const auto& radiance = shape.placed->source->radiance)
            brightest = std::max(brightest, largestOf(*radiance * shape.radiance.tint * shape.radiance.largest));
    const bool isOrdinary = brightest >= 0x1p-10 && brightest <= 0x1p24;
    const bool isFloat = brightest <= double(std::numeric_limits<float>::max()) && float(brightest) > 0.0f;
    return isOrdinary || !isFloat ? 1.0 : std::exp2(std::ilogb(brightest));
}

EmitterDescription inUnits(const EmitterDescription& emitter, double unit) {
    EmitterDescription result = emitter;
    result.value /= unit;
    result.sky.bottom /= unit;
    result.sky.top /= unit;
    result.sky.starRadiance /= unit;
    return result;
}

}  // namespace parhelion
