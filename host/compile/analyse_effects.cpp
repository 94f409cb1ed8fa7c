#include <fmt/format.h>

#include <algorithm>

#include "compile/compile_scene.h"

namespace parhelion {

namespace {

class Analysis {
public:
    explicit Analysis(const CompiledScene& scene) : scene_(scene), constants_(scene.constants) {}

    EffectSet run() {
        surfaces();
        media();
        phaseFunctions();
        lights();
        lightSampling();
        decide(Effect::hasDepthLimit, constants_.maxDepth != shared::kNone,
               fmt::format("paths end after depth {}", constants_.maxDepth), "paths end by roulette alone");
        decide(Effect::hasFilterTable, !scene_.filterTable.empty(),
               fmt::format("the reconstruction filter reaches {} pixels",
                           scene_.filterTable.empty() ? 0.5f : -scene_.filterTable.front()),
               "the reconstruction filter is the pixel's box");
        decide(Effect::hasDepthLayers, constants_.depthLayers > 0,
               countOf(constants_.depthLayers, "layer", "layers") + " by number of scatterings",
               "no layers by number of scatterings are asked for");
        return std::move(effects_);
    }

private:
    void decide(Effect effect, bool on, const std::string& why, const std::string& whyNot) {
        const auto index = static_cast<unsigned>(effect);
        effects_.on[index] = on;
        effects_.reasons[index] = on ? "yes: " + why : "no: " + whyNot;
    }

    static std::string countOf(std::size_t count, const std::string& one, const std::string& many) {
        return fmt::format("{} {}", count, count == 1 ? one : many);
    }

    template <typename Predicate>
    std::size_t countShapes(Predicate accept) const {
        return std::size_t(std::ranges::count_if(scene_.shapes, accept));
    }

    template <typename Predicate>
    std::size_t countMedia(Predicate accept) const {
        return std::size_t(std::count_if(constants_.media, constants_.media + constants_.mediumCount, accept));
    }

    template <typename Predicate>
    std::size_t countLights(Predicate accept) const {
        return std::size_t(std::count_if(constants_.lights, constants_.lights + constants_.lightCount, accept));
    }

    void surfaces() {
        const std::size_t opaque = countShapes([](const auto& shape) { return !(shape.flags & shared::kShapeNull); });
        const std::size_t twoSided =
            countShapes([](const auto& shape) { return shape.flags & shared::kShapeTwoSided; });
        decide(Effect::hasSurfaces, opaque > 0, countOf(opaque, "opaque shape", "opaque shapes"), "no opaque shape");
        decide(Effect::hasQuads, constants_.quadCount > 0,
               countOf(constants_.quadCount, "parallelogram", "parallelograms"), "no parallelogram");
        decide(Effect::hasSpheres, constants_.sphereCount > 0, countOf(constants_.sphereCount, "sphere", "spheres"),
               "no sphere");
        decide(Effect::hasBoxes, constants_.boxCount > 0, countOf(constants_.boxCount, "box", "boxes"), "no box");
        decide(Effect::hasTriangles, constants_.triangleCount > 0,
               countOf(constants_.triangleCount, "triangle", "triangles"), "no triangle");
        decide(Effect::hasDoubleSided, twoSided > 0, countOf(twoSided, "two-sided shape", "two-sided shapes"),
               "every surface is one-sided");
        const std::size_t textured = countShapes([](const auto& shape) { return shape.texture != shared::kNone; });
        decide(Effect::hasTextures, textured > 0, countOf(textured, "textured shape", "textured shapes"),
               "every reflectance is constant");
        decide(Effect::hasVertexNormals, !scene_.vertexNormals.empty(), "a mesh has vertex normals",
               "every triangle is flat");
    }

    void media() {
        using shared::Medium;
        const std::size_t count = constants_.mediumCount;
        const std::size_t homogeneous =
            countMedia([](const Medium& medium) { return medium.flags & shared::kMediumHomogeneous; });
        const std::size_t chromatic = countMedia([](const Medium& medium) {
            return medium.sigmaRatio != glm::vec3(1.0f) || (medium.flags & shared::kMediumColorDensity) != 0;
        });
        const std::size_t albedoGrids =
            countMedia([](const Medium& medium) { return medium.flags & shared::kMediumAlbedoGrid; });
        const std::size_t bricked =
            countMedia([](const Medium& medium) { return medium.flags & shared::kMediumBricked; });
        decide(Effect::hasMedia, count > 0, countOf(count, "medium", "media"), "no medium");
        decide(Effect::hasManyMedia, count > 1, countOf(count, "medium", "media"), countOf(count, "medium", "media"));
        const auto nested = std::size_t(std::ranges::count_if(
            scene_.shapes, [](const shared::Shape& shape) { return shape.exterior != shared::kNone; }));
        decide(Effect::hasNestedMedia, nested > 0, countOf(nested, "nested boundary", "nested boundaries"),
               "no medium surrounds another");
        decide(Effect::hasHomogeneousMedia, homogeneous > 0,
               countOf(homogeneous, "homogeneous medium", "homogeneous media"), "no homogeneous medium");
        decide(Effect::hasHeterogeneousMedia, count > homogeneous,
               countOf(count - homogeneous, "medium with a density grid", "media with density grids"),
               "no density grid");
        decide(Effect::hasChromaticExtinction, chromatic > 0,
               countOf(chromatic, "medium's extinction", "media's extinctions") + " differ between channels",
               "every extinction is grey");
        decide(Effect::hasAlbedoGrids, albedoGrids > 0, countOf(albedoGrids, "albedo grid", "albedo grids"),
               "every albedo is constant");
        const std::size_t colored =
            countMedia([](const Medium& medium) { return medium.flags & shared::kMediumColorDensity; });
        decide(Effect::hasColorDensity, colored > 0,
               countOf(colored, "grid of three channels", "grids of three channels"), "every density grid is grey");
        decide(Effect::hasBrickedDensity, bricked > 0, "a density grid is large and sparse, or huge",
               "dense grids are small enough");
    }

    void phaseFunctions() {
        using shared::Medium;
        const auto countPhase = [&](std::uint32_t phase) {
            return countMedia([&](const Medium& medium) { return medium.phase == phase; });
        };
        const std::size_t anisotropic = countPhase(shared::kPhaseHenyeyGreenstein);
        decide(Effect::hasHenyeyGreenstein, anisotropic > 0,
               countOf(anisotropic, "Henyey-Greenstein phase function", "Henyey-Greenstein phase functions"),
               "no Henyey-Greenstein phase function of one lobe");
        decide(Effect::hasDualHenyeyGreenstein, countPhase(shared::kPhaseDualHenyeyGreenstein) > 0,
               "a medium scatters in two lobes", "no phase function of two lobes");
        decide(Effect::hasRayleigh, countPhase(shared::kPhaseRayleigh) > 0, "a medium scatters as small particles do",
               "no Rayleigh phase function");
        decide(Effect::hasTabulatedPhase, countPhase(shared::kPhaseTabulated) > 0, "a phase function is tabulated",
               "no tabulated phase function");
    }

    void lights() {
        using shared::Light;
        const std::size_t delta = countLights([](const Light& light) {
            return light.type == shared::kLightDirectional || light.type == shared::kLightPoint;
        });
        const std::size_t area = countLights([](const Light& light) {
            return light.type == shared::kLightQuad || light.type == shared::kLightSphere ||
                   light.type == shared::kLightMesh;
        });
        const std::size_t texturedLights =
            countLights([](const Light& light) { return light.texture != shared::kNone; });
        decide(Effect::hasTexturedLights, texturedLights > 0,
               countOf(texturedLights, "textured light", "textured lights"), "every area light is uniform");
        const std::size_t twoSided =
            countLights([](const Light& light) { return (light.flags & shared::kLightTwoSided) != 0; });
        decide(Effect::hasTwoSidedLights, twoSided > 0, countOf(twoSided, "two-sided light", "two-sided lights"),
               "every area light emits on its front alone");
        const bool environment = constants_.environment != shared::kNone;
        const bool environmentSampled = environment && constants_.lights[constants_.environment].selection > 0.0f;
        const std::uint32_t surrounding = environment ? constants_.lights[constants_.environment].type : shared::kNone;
        decide(Effect::hasEnvironmentMap, surrounding == shared::kLightEnvironmentMap, "an environment map is given",
               "no environment map");
        decide(Effect::hasSky, surrounding == shared::kLightSky, "a gradient sky is given", "no gradient sky");
        decide(Effect::hasStars, surrounding == shared::kLightSky && constants_.sky.starCount > 0,
               countOf(constants_.sky.starCount, "star", "stars"), "no star");
        decide(Effect::hasEnvironment, environment, "an emitter surrounds the scene", "no emitter surrounds the scene");
        decide(Effect::hasEnvironmentSampling, environmentSampled, "it is sampled like other lights",
               !environment                     ? "no emitter surrounds the scene"
               : constants_.emitterSamples == 0 ? "light sampling takes no samples"
                                                : "scattering finds an environment of low contrast as well");
        decide(Effect::hasDeltaLights, delta > 0,
               countOf(delta, "directional or point light", "directional and point lights"),
               "no directional or point light");
        decide(Effect::hasAreaLights, area > 0, countOf(area, "area light", "area lights"), "no area light");
    }

    void lightSampling() {
        using shared::Light;
        decide(Effect::hasStrategyWeights, constants_.emitterSamples != 1.0f || constants_.scatterSamples != 1.0f,
               fmt::format("light samples weigh {}, scattering samples {}", constants_.emitterSamples,
                           constants_.scatterSamples),
               "light and scattering samples weigh the same");
        // Those that light sampling chooses from, and those that are looked up where a path meets them.
        const std::size_t listed = countLights([](const Light& light) {
            return light.selection > 0.0f || light.type == shared::kLightQuad || light.type == shared::kLightSphere ||
                   light.type == shared::kLightMesh;
        });
        decide(Effect::hasManyLights, listed > 1, countOf(listed, "sampled or area light", "sampled or area lights"),
               countOf(listed, "sampled or area light", "sampled or area lights"));
    }

    const CompiledScene& scene_;
    const shared::SceneConstants& constants_;
    EffectSet effects_;
};

}  // namespace

EffectSet analyseEffects(const CompiledScene& scene) { return Analysis(scene).run(); }

}  // namespace parhelion
