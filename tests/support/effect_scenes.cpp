#include "effect_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compile/compile_scene.h"
#include "compile/density_storage.h"
#include "image/image.h"
#include "support/scene_parts.h"

namespace parhelion::test {
namespace {

/// Media whose phase functions are not of one lobe.
std::vector<NamedScene> phaseScenes(glm::uvec2 size) {
    const auto ballOf = [](const std::string& id, const std::string& phase, const std::string& place) {
        return fogScattering(id, phase) + around(id, "sphere", "<scale value=\"0.5\"/><translate " + place + "/>");
    };
    const auto compiled = [size](const std::string& body) { return compileText(sceneXml(body), size); };
    return {{"two lobes, sun, sky", compiled(kSky + kSun + fogScattering("fog", kTwoLobes) + around("fog", "cube"))},
            {"tabulated phase function, quad light",
             compiled(kFloor + kQuadLight + fogScattering("fog", kPhaseTable) + around("fog", "cube"))},
            {"media of every phase function, point light",
             compiled(kLamp + kSky + ballOf("a", kSmallParticles, "x=\"-0.6\"") + ballOf("b", kTwoLobes, "x=\"0.6\"") +
                      ballOf("c", kPhaseTable, "y=\"0.8\"") + ballOf("d", "<phase type=\"hg\"/>", "y=\"-0.8\""))}};
}

/// What integrators other than the plain path tracers do, and a grid with a value a channel.
std::vector<NamedScene> furtherScenes(const TemporaryFolder& folder, glm::uvec2 size) {
    const SceneFrame fourToOne{
        .integrator = R"(<integrator type="direct"><integer name="emitter_samples" value="4"/></integrator>)"};
    const SceneFrame layered{.integrator =
                                 R"(<integrator type="volpath"><integer name="depth_layers" value="3"/></integrator>)"};
    const std::string meshAndFloor =
        kFloor + ball(folder, false, R"(<scale value="0.5"/><translate x="-1.3" y="-0.4" z="0.8"/>)", kTwoSided);
    return {{"direct lighting, four light samples to one",
             compileText(sceneXml(meshAndFloor + kSky + kSun + kQuadLight, fourToOne), size)},
            {"cloud of three densities, fog, sky, sun",
             compileText(sceneXml(kSky + kSun + colorCloud(folder) + around("cloud", "cube") +
                                  homogeneous("small", "4, 2, 1", 0) +
                                  around("small", "sphere", R"(<scale value="0.4"/><translate x="1.5"/>)")),
                         size)},
            {"layers by depth, fog, quad light",
             compileText(
                 sceneXml(kFloor + kSky + kQuadLight + homogeneous("fog", "1.5", 0.6) + around("fog", "cube"), layered),
                 size)}};
}

const std::string kCheckers =
    R"(<texture type="checkerboard" name="reflectance"><rgb name="color0" value="0.8, 0.7, 0.5"/>
    <transform name="to_uv"><scale x="6" y="5"/></transform></texture>)";

/// A bitmap of 8 x 4 colours.
std::string bitmapTexture(const TemporaryFolder& folder, const std::string& role, const std::string& more) {
    Image image{.size = {8, 4}, .channels = {}, .attributes = {}};
    for (const char* channel : {"B", "G", "R"})
        for (int i = 0; i < 32; ++i) image.channels[channel].push_back(float((i * 37 + 11 * channel[0]) % 64) / 64.0f);
    writeExr(folder.path() / "bitmap.exr", image);
    return fmt::format(R"(<texture type="bitmap" name="{}"><string name="filename" value="{}"/>{}</texture>)", role,
                       (folder.path() / "bitmap.exr").string(), more);
}

/// Textures on every kind of shape, as reflectance and as radiance.
std::vector<NamedScene> texturedScenes(const TemporaryFolder& folder, glm::uvec2 size) {
    const auto compiled = [size](const std::string& body) { return compileText(sceneXml(body), size); };
    const auto bitmap = [&](const std::string& more) { return bitmapTexture(folder, "reflectance", more); };
    const auto diffuse = [](const std::string& texture) { return "<bsdf type=\"diffuse\">" + texture + "</bsdf>"; };
    const std::string floor = R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/>
    <scale value="4"/><translate y="-1"/></transform>)" +
                              diffuse(kCheckers) + "</shape>";
    const std::string ball_ = R"(<shape type="sphere"><transform name="to_world"><rotate x="1" angle="60"/>
    <scale value="0.8"/><translate x="-1.2"/></transform>)" +
                              diffuse(bitmap(R"(<string name="wrap_mode" value="mirror"/>
    <transform name="to_uv"><scale x="3" y="2"/></transform>)")) +
                              "</shape>";
    const std::string block =
        R"(<shape type="cube"><transform name="to_world"><rotate y="1" angle="30"/><scale value="0.5"/>
    <translate x="0.9" y="-0.4"/></transform><bsdf type="twosided">)" +
        diffuse(bitmap(R"(<string name="wrap_mode" value="clamp"/>
    <string name="filter_type" value="nearest"/>)")) +
        "</bsdf></shape>";
    const auto lamp = [&](const std::string& shape) {
        return shape + "<emitter type=\"area\">" +
               bitmapTexture(folder, "radiance", R"(<transform name="to_uv"><scale value="2"/></transform>)") +
               "</emitter></shape>";
    };
    const std::string quadLamp = lamp(R"(<shape type="rectangle"><transform name="to_world"><scale value="0.8"/>
    <rotate x="1" angle="90"/><translate x="0.3" y="1.7"/></transform>)");
    const std::string ballLamp = lamp(R"(<shape type="sphere"><point name="center" x="-1.4" y="0.9" z="0.4"/>
    <float name="radius" value="0.4"/>)");
    const std::string meshLamp = lamp(R"(<shape type="cube"><transform name="to_world"><scale value="0.3"/>
    <rotate x="0.6" y="0.8" angle="40"/><translate x="1.4" y="1"/></transform>)");
    return {{"textured shapes, sky", compiled(kSky + floor + ball_ + block)},
            {"textured lights, textured mesh, fog",
             compiled(floor + quadLamp + ballLamp + meshLamp + fogScattering("fog", "") + around("fog", "cube") +
                      ball(folder, false, "<scale value=\"0.5\"/><translate z=\"1.5\"/>", diffuse(bitmap(""))))}};
}

/// Skies of every kind.
std::vector<NamedScene> skyScenes(glm::uvec2 size) {
    const std::string greyBox = homogeneous("fog", "1.5", 0.6) + around("fog", "cube");
    const std::string isotropicCloud = cloud("cloud", kWhite, "isotropic") + around("cloud", "cube");
    CompileOptions everyLight;
    everyLight.sampleEveryLight = true;
    const auto compiled = [size](const std::string& body) { return compileText(sceneXml(body), size); };
    return {
        {"sky sampled, fog", compileText(sceneXml(kSky + kSphereLight + greyBox), size, everyLight)},
        {"empty sky", compiled(kSky)},
        {"gradient sky, fog", compiled(kFloor + gradientSky("") + greyBox)},
        {"gradient sky sampled, fog", compileText(sceneXml(kFloor + gradientSky("") + greyBox), size, everyLight)},
        {"starry sky, cloud, sun", compiled(kFloor + gradientSky(kStars) + kSun + isotropicCloud)},
        {"environment map, fog", compiled(kFloor + environmentMap() + greyBox)},
        {"environment map, lamp", compiled(kFloor + environmentMap() + kQuadLight)},
        {"empty environment map", compiled(environmentMap())},
    };
}

CompiledScene makeChromatic(CompiledScene scene) {
    scene.constants.media[0].sigmaRatio = {1.0f, 0.7f, 0.45f};
    scene.effects = analyseEffects(scene);
    return scene;
}

CompiledScene makeBricked(CompiledScene scene) {
    storeAsBricks(scene);
    return scene;
}

}  // namespace

void storeAsBricks(CompiledScene& scene) {
    const std::vector<float> dense = std::exchange(scene.density, {});
    for (std::uint32_t i = 0; i < scene.constants.mediumCount; ++i) {
        shared::Medium& medium = scene.constants.media[i];
        if (medium.flags & shared::kMediumHomogeneous) continue;
        const glm::uvec3 n = medium.resolution;
        const DensityGrid grid =
            DensityGrid::fromDense(n, std::span(dense).subspan(medium.voxelOffset, std::size_t(n.x) * n.y * n.z));
        medium.voxelOffset = appendDensity(grid, true, scene);
        medium.flags |= shared::kMediumBricked;
    }
    scene.effects = analyseEffects(scene);
}

std::vector<NamedScene> effectScenes(const TemporaryFolder& folder, glm::uvec2 size) {
    const SceneFrame shallow{.integrator = R"(<integrator type="volpath"><integer name="max_depth" value="3"/>
</integrator>)",
                             .filter = "gaussian"};
    const std::string greyBox = homogeneous("fog", "1.5", 0.6) + around("fog", "cube");
    const std::string isotropicCloud = cloud("cloud", kWhite, "isotropic") + around("cloud", "cube");
    const std::string colouredCloud = cloud("cloud", albedoGrid(folder), "hg") + around("cloud", "cube");
    const std::string smallFog =
        homogeneous("small", "4, 2, 1", 0) + around("small", "sphere", R"(<scale value="0.4"/><translate x="1.5"/>)");
    const std::string smallBall = R"(<scale value="0.5"/><translate x="-1.3" y="-0.4" z="0.8"/>)";
    const auto compiled = [size](const std::string& body, const SceneFrame& frame = {}) {
        return compileText(sceneXml(body, frame), size);
    };
    std::vector<NamedScene> scenes{
        {"quad light, fog", compiled(kFloor + kQuadLight + greyBox)},
        {"chromatic fog in a sphere, sky",
         compiled(kSky + homogeneous("fog", "3, 1.5, 0.7", 0.3) + around("fog", "sphere"))},
        {"chromatic cloud, sun, sky", makeChromatic(compiled(kFloor + kSky + kSun + isotropicCloud))},
        {"albedo grid, sphere light", compiled(kFloor + kSphereLight + colouredCloud)},
        {"several media, mesh light, point light",
         compiled(kFloor + kLamp + colouredCloud + smallFog + ball(folder, true, smallBall, kMeshLight))},
        {"two-sided smooth mesh, point light, sun", compiled(kLamp + kSun + ball(folder, false, "", kTwoSided))},
        {"medium in a mesh, quad light, sky",
         compiled(kSky + kQuadLight + homogeneous("fog", "2", 0) +
                  ball(folder, true, "", R"(<bsdf type="null"/><ref name="interior" id="fog"/>)"))},
        {"depth limit, gaussian filter, fog", compiled(kFloor + kSky + kSun + greyBox, shallow)},
        {"bricked cloud, quad light", makeBricked(compiled(kFloor + kQuadLight + isotropicCloud))},
        {"camera inside a cloud", compiled(kSky + kLamp + colouredCloud, {.origin = "0.1, 0.2, 0.6"})},
        {"nested media, sky",
         compiled(kSky + homogeneous("outer", "1.5", 0) + around("outer", "cube") + homogeneous("inner", "5", 0.5) +
                  R"(<shape type="sphere"><float name="radius" value="0.5"/><bsdf type="null"/>
    <ref name="interior" id="inner"/><ref name="exterior" id="outer"/></shape>)")},
        {"two-sided lights, fog",
         compiled(kFloor + kTwoSidedQuad + kSphereLight + greyBox + ball(folder, true, smallBall, kTwoSidedMesh))},
    };
    for (auto more : {skyScenes(size), phaseScenes(size), furtherScenes(folder, size), texturedScenes(folder, size)})
        std::ranges::move(more, std::back_inserter(scenes));
    return scenes;
}

}  // namespace parhelion::test
