#include "compile/compile_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "compile/compile_environment.h"
#include "compile/compile_sky.h"
#include "compile/distribution_table.h"
#include "compile/luminance.h"
#include "compile/radiance_unit.h"
#include "compile/transforms.h"
#include "compile/triangle_soup.h"

namespace parhelion {

namespace {

constexpr double kPi = std::numbers::pi;
// A sky up to this contrast is left to scattering, as a constant one is: a light sample of it has about the variance of
// a scattered direction, costs a shadow ray, and takes the place of a sample of a light that only sampling finds.
constexpr double kLowContrast = 2.0;

bool isBlack(const glm::vec3& rgb) { return rgb == glm::vec3(0.0f); }

bool isDelta(const EmitterDescription& emitter) {
    using Type = EmitterDescription::Type;
    return emitter.type == Type::Directional || emitter.type == Type::Point;
}

/// Radius of a sphere around everything that light can fall on; 1 when there is nothing.
double sceneRadius(std::span<const KeptShape> shapes) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const KeptShape& shape : shapes) {
        lower = glm::min(lower, shape.placed->lower);
        upper = glm::max(upper, shape.placed->upper);
    }
    return shapes.empty() ? 1.0 : 0.5 * glm::distance(lower, upper);
}

TriangleVertices triangleAt(const CompiledScene& scene, std::size_t local) {
    const glm::vec4* texel = &scene.triangles[shared::kTriangleTexels * local];
    return {glm::vec3(texel[0]), glm::vec3(texel[1]), glm::vec3(texel[2])};
}

class LightCompiler {
public:
    LightCompiler(std::span<const KeptShape> shapes, std::span<const EmissiveGeometry> geometry, bool sampleEveryLight,
                  CompiledScene& scene)
        : shapes_(shapes),
          geometry_(geometry),
          sampleEveryLight_(sampleEveryLight || scene.constants.scatterSamples == 0.0f),
          sampleNoLight_(scene.constants.emitterSamples == 0.0f),
          radius_(sceneRadius(shapes)),
          scene_(scene) {
        scene.constants.environment = shared::kNone;
    }

    void addArea(std::uint32_t shapeIndex) {
        const ShapeDescription& source = *shapes_[shapeIndex].placed->source;
        const EmissiveGeometry& geometry = geometry_[shapeIndex];
        const bool hasSurface = geometry.primitive != shared::kNone || !geometry.triangles.empty();
        if (!source.radiance || !hasSurface) return;
        const SurfaceTexture& texture = shapes_[shapeIndex].radiance;
        const glm::dvec3 tinted = *source.radiance * texture.tint;
        const glm::vec3 radiance =
            radianceOf(tinted, texture.index != shared::kNone, source.where, nameOf(source) + ": radiance");
        if (isBlack(radiance)) return noteBlack(nameOf(source), tinted);
        const glm::dvec3 mean = texture.index == shared::kNone ? tinted : tinted * texture.mean;
        shared::Light light{};
        light.texture = texture.index;
        light.emission = radiance;
        const double area = writeSurface(shapeIndex, light);
        if (source.emitsOnBothSides) light.flags |= shared::kLightTwoSided;
        const double sides = source.emitsOnBothSides ? 2.0 : 1.0;
        // From outside, where it would be sampled, a sphere that emits inwards alone is dark.
        const bool inwards = sides == 1.0 && light.type == shared::kLightSphere &&
                             (scene_.shapes[shapeIndex].flags & shared::kShapeFlipNormal) != 0;
        append({light, inwards ? 0.0 : sides * kPi * area * luminance(mean / scene_.radianceUnit), shapeIndex},
               source.where);
    }

    void addEmitter(const EmitterDescription& emitter) {
        static constexpr const char* kNames[] = {"directional emitter", "point emitter", "constant emitter",
                                                 "environment map", "sky"};
        const std::string name = kNames[static_cast<int>(emitter.type)];
        if (emitter.type == EmitterDescription::Type::Sky) return addSky(emitter);
        if (emitter.type == EmitterDescription::Type::EnvironmentMap) return addEnvironmentMap(emitter);
        shared::Light light{};
        light.texture = shared::kNone;
        light.emission = toFloat(emitter.value, emitter.where, name);
        if (isBlack(light.emission)) return noteBlack(name, emitter.value);
        light.primitive = shared::kNone;
        const double flux = luminance(light.emission);
        if (sampleNoLight_ && isDelta(emitter)) return noteLost(name);
        switch (emitter.type) {
            case EmitterDescription::Type::Directional:
                light.type = shared::kLightDirectional;
                light.vector = glm::vec3(glm::normalize(emitter.vector));
                return append({light, flux * kPi * radius_ * radius_, shared::kNone}, emitter.where);
            case EmitterDescription::Type::Point:
                light.type = shared::kLightPoint;
                light.vector = toFloat(emitter.vector - scene_.worldOrigin, emitter.where, name + ": position");
                return append({light, 4.0 * kPi * flux, shared::kNone}, emitter.where);
            case EmitterDescription::Type::Constant:
                light.type = shared::kLightEnvironment;
                scene_.constants.environmentRadiance = light.emission;
                return append(
                    {light, sampleEveryLight_ ? 4.0 * kPi * kPi * radius_ * radius_ * flux : 0.0, shared::kNone},
                    emitter.where);
            case EmitterDescription::Type::Sky:
            case EmitterDescription::Type::EnvironmentMap:
                return;  // above
        }
    }

    void addEnvironmentMap(const EmitterDescription& emitter) {
        if (isUniform(emitter.map)) {
            EmitterDescription uniform;
            uniform.where = emitter.where;
            uniform.value = glm::dvec3(emitter.map.texels.front()) * emitter.value;
            return uniform.value == glm::dvec3(0.0) ? noteBlack("environment map", uniform.value) : addEmitter(uniform);
        }
        const bool scatteringCounts = scene_.constants.scatterSamples > 0.0f;
        if (emitter.misCompensation && !scatteringCounts)
            scene_.notes.push_back("environment map: without scattering samples there is no MIS compensation");
        const glm::dvec3 mean = compileEnvironment(emitter, emitter.misCompensation && scatteringCounts, scene_);
        addSurrounding(shared::kLightEnvironmentMap, "environment map", mean, true, emitter.where);
    }

    void addSky(const EmitterDescription& emitter) {
        if (emitter.sky.starDensity > 0.0 && emitter.sky.starRadiance == glm::dvec3(0.0))
            scene_.notes.push_back("sky: its stars are black");
        if (isUniform(emitter.sky)) {
            EmitterDescription uniform;
            uniform.where = emitter.where;
            uniform.value = skyGradientAt(emitter.sky, 0.0);
            return uniform.value == glm::dvec3(0.0) ? noteBlack("sky", uniform.value) : addEmitter(uniform);
        }
        const glm::dvec3 mean = compileSky(emitter.sky, emitter.where, scene_);
        const bool sampled =
            sampleEveryLight_ || mean == glm::dvec3(0.0) || skyContrast(emitter.sky, scene_) > kLowContrast;
        addSurrounding(shared::kLightSky, "sky", mean, sampled, emitter.where);
    }

    /// A light that shines from everywhere, of the given mean radiance.
    void addSurrounding(std::uint32_t type, const char* name, const glm::dvec3& mean, bool sampled,
                        const SourceLocation& where) {
        if (mean == glm::dvec3(0.0)) return noteBlack(name, mean);
        shared::Light light{};
        light.emission = glm::vec3(mean);  // for those who list lights
        light.type = type;
        light.texture = light.primitive = shared::kNone;
        const double power = sampled ? 4.0 * kPi * kPi * radius_ * radius_ * luminance(mean) : 0.0;
        append({light, power, shared::kNone}, where);
    }

    /// Lights that are sampled come first, so that the others need no place in the search.
    void finish() {
        std::ranges::stable_partition(pending_, [](const Pending& light) { return light.power > 0.0; });
        shared::SceneConstants& constants = scene_.constants;
        std::vector<double> powers;
        for (const Pending& pending : pending_) {
            const std::uint32_t index = constants.lightCount++;
            constants.lights[index] = pending.light;
            powers.push_back(pending.power);
            if (pending.shape != shared::kNone) scene_.shapes[pending.shape].light = index;
            const bool surrounds = pending.light.type == shared::kLightEnvironment ||
                                   pending.light.type == shared::kLightEnvironmentMap ||
                                   pending.light.type == shared::kLightSky;
            if (surrounds) constants.environment = index;
        }
        assignSelection(powers, std::span(constants.lights).first(constants.lightCount));
    }

private:
    struct Pending {
        shared::Light light;
        double power;         ///< 0: never sampled
        std::uint32_t shape;  ///< that emits it, or kNone
    };

    /// @param value  as given, which single precision took for 0.
    void noteBlack(const std::string& name, const glm::dvec3& value) {
        scene_.notes.push_back(value == glm::dvec3(0.0)
                                   ? fmt::format("{}: its light is black", name)
                                   : fmt::format("{}: its light is too faint for single precision, or beside the "
                                                 "scene's brightest light, and was dropped",
                                                 name));
    }

    /// In multiples of the scene's unit.
    glm::vec3 radianceOf(const glm::dvec3& value, bool tints, const SourceLocation& where,
                         const std::string& subject) const {
        toFloat(value, where, subject);
        const glm::vec3 result(value / scene_.radianceUnit);
        // Beside bright texels a tint may fall below float, and would take the digits of their product with it.
        for (int c = 0; c < 3 && tints; ++c)
            if (value[c] > 0.0 && result[c] < std::numeric_limits<float>::min())
                throw InputError(where,
                                 fmt::format("{} must not be below the scene's brightest light, about {:.3g}, by more "
                                             "than single precision spans (1e38); got {}",
                                             subject, scene_.radianceUnit, value[c]));
        return result;
    }

    void noteLost(const std::string& name) {
        scene_.notes.push_back(fmt::format("{}: its light is lost, for scattering alone never finds it", name));
    }

    void append(Pending light, const SourceLocation& where) {
        if (sampleNoLight_) light.power = 0.0;
        if (pending_.size() == shared::kMaxLights)
            throw InputError(where, fmt::format("a scene may have at most {} lights", shared::kMaxLights));
        pending_.push_back(light);
    }

    /// Type, primitive and triangle list. Returns the area.
    double writeSurface(std::uint32_t shapeIndex, shared::Light& light) {
        const PlacedShape& shape = *shapes_[shapeIndex].placed;
        const EmissiveGeometry& geometry = geometry_[shapeIndex];
        light.primitive = geometry.primitive;
        if (!geometry.triangles.empty()) return writeTriangles(geometry.triangles, light);
        if (shape.kind == PlacedShape::Kind::Sphere) {
            light.type = shared::kLightSphere;
            return 4.0 * kPi * shape.radius * shape.radius;
        }
        light.type = shared::kLightQuad;
        return scene_.constants.quads[geometry.primitive].area;
    }

    double writeTriangles(std::span<const std::uint32_t> primitives, shared::Light& light) {
        const shared::SceneConstants& constants = scene_.constants;
        const std::uint32_t firstTriangle = constants.quadCount + constants.sphereCount + constants.boxCount;
        std::vector<double> areas;
        for (const std::uint32_t primitive : primitives)
            areas.push_back(areaOf(triangleAt(scene_, primitive - firstTriangle)));
        const DistributionTable table = buildDistribution(areas);

        light.type = shared::kLightMesh;
        light.primitive = primitives.front();
        light.triangleCount = std::uint32_t(primitives.size());
        light.triangleOffset = std::uint32_t(scene_.lightTriangles.size());
        light.distribution = std::uint32_t(scene_.distributions.size());
        scene_.lightTriangles.insert(scene_.lightTriangles.end(), primitives.begin(), primitives.end());
        scene_.distributions.insert(scene_.distributions.end(), table.texels.begin(), table.texels.end());
        scene_.triangleAreas.resize(constants.triangleCount, 0.0f);
        for (std::size_t i = 0; i < areas.size(); ++i)
            if (areas[i] > 0.0)
                scene_.triangleAreas[primitives[i] - firstTriangle] = float(areas[i] / table.probabilities[i]);
        return std::accumulate(areas.begin(), areas.end(), 0.0);
    }

    std::span<const KeptShape> shapes_;
    std::span<const EmissiveGeometry> geometry_;
    bool sampleEveryLight_;
    bool sampleNoLight_;  ///< scattering alone finds light
    double radius_;
    CompiledScene& scene_;
    std::vector<Pending> pending_;
};

void rejectSecondEnvironment(const SceneDescription& description) {
    const EmitterDescription* first = nullptr;
    for (const EmitterDescription& emitter : description.emitters) {
        using Type = EmitterDescription::Type;
        if (emitter.type == Type::Directional || emitter.type == Type::Point) continue;
        if (first)
            throw InputError(
                emitter.where,
                fmt::format("a scene may have one emitter that surrounds it; the first is at {}", first->where.text()));
        first = &emitter;
    }
}

}  // namespace

void compileLights(const SceneDescription& description, std::span<const KeptShape> shapes,
                   std::span<const EmissiveGeometry> geometry, bool sampleEveryLight, CompiledScene& scene) {
    rejectSecondEnvironment(description);
    scene.radianceUnit = chooseRadianceUnit(description, shapes, sceneRadius(shapes));
    LightCompiler lights(shapes, geometry, sampleEveryLight, scene);
    for (std::uint32_t i = 0; i < shapes.size(); ++i) lights.addArea(i);
    for (const EmitterDescription& emitter : description.emitters)
        lights.addEmitter(scene.radianceUnit == 1.0 ? emitter : inUnits(emitter, scene.radianceUnit));
    lights.finish();
}

}  // namespace parhelion
