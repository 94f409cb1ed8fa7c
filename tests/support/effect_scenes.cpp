#include "effect_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compile/compile_scene.h"
#include "compile/density_storage.h"
#include "image/image.h"
#include "support/hand_scene.h"
#include "support/render_scene.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

const std::string kFloor = R"(<shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/><translate y="-1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.6, 0.4"/></bsdf>
</shape>)";
const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.7"/></emitter>)";
const std::string kStars = R"(<float name="star_density" value="20"/><float name="star_size" value="3"/>
    <rgb name="star_radiance" value="20, 30, 40"/>)";
const std::string kSun = R"(<emitter type="directional"><vector name="direction" x="-0.6" y="-0.7" z="-0.3"/>
    <rgb name="irradiance" value="3, 2.7, 2.2"/></emitter>)";
const std::string kLamp = R"(<emitter type="point"><point name="position" x="1" y="1.6" z="1.5"/>
    <rgb name="intensity" value="4, 3, 2"/></emitter>)";
const std::string kQuadLight = R"(<shape type="rectangle">
    <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate x="0.3" y="1.7"/></transform>
    <emitter type="area"><rgb name="radiance" value="6, 5, 4"/></emitter>
</shape>)";
const std::string kSphereLight = R"(<shape type="sphere">
    <point name="center" x="-1.2" y="0.9" z="0.4"/><float name="radius" value="0.3"/>
    <emitter type="area"><rgb name="radiance" value="5, 6, 7"/></emitter>
</shape>)";

/// A tilted gradient with a kink above the horizon.
std::string gradientSky(const std::string& stars) {
    return R"(<emitter type="sky"><vector name="axis" x="0.2" y="1" z="0.3"/><float name="offset" value="-0.1"/>
    <float name="width" value="0.7"/><float name="power" value="1.5"/>
    <rgb name="bottom" value="0.7, 0.5, 0.3"/><rgb name="top" value="0.2, 0.4, 0.9"/>)" +
           stars + "</emitter>";
}
/// Faces up, away from the floor.
const std::string kTwoSidedQuad = R"(<shape type="rectangle">
    <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="-80"/><translate x="0.3" y="1.7"/></transform>
    <emitter type="area"><rgb name="radiance" value="6, 5, 4"/><boolean name="two_sided" value="true"/></emitter>
</shape>)";

/// A shape around a medium.
std::string around(const std::string& medium, const std::string& shape, const std::string& transform = "") {
    return fmt::format(R"(<shape type="{}"><transform name="to_world">{}</transform>
    <bsdf type="null"/><ref name="interior" id="{}"/></shape>)",
                       shape, transform, medium);
}

std::string homogeneous(const std::string& id, const std::string& sigma, double g) {
    return fmt::format(R"(<medium type="homogeneous" id="{}"><rgb name="sigma_t" value="{}"/>
    <rgb name="albedo" value="0.95, 0.9, 0.8"/><phase type="hg"><float name="g" value="{}"/></phase></medium>)",
                       id, sigma, g);
}

std::string fogScattering(const std::string& id, const std::string& phase) {
    return fmt::format(R"(<medium type="homogeneous" id="{}"><float name="sigma_t" value="2"/>
    <float name="albedo" value="0.95"/>{}</medium>)",
                       id, phase);
}

const std::string kTwoLobes = R"(<phase type="dual_hg"><float name="g1" value="0.85"/><float name="g2" value="-0.3"/>
    <float name="weight" value="0.7"/></phase>)";
const std::string kSmallParticles = R"(<phase type="rayleigh"/>)";
const std::string kPhaseTable = R"(<phase type="tabphase"><string name="values" value="2 0.5 0 0 1 1 4 20"/></phase>)";

/// The cumulus over [-1, 1]^3. The extinction of a grid is grey in the scene language; see makeChromatic.
std::string cloud(const std::string& id, const std::string& albedo, const std::string& phase) {
    return fmt::format(
        R"(<medium type="heterogeneous" id="{}"><float name="scale" value="12"/>
    <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>
    {}<phase type="{}"/></medium>)",
        id, (sceneFolder() / "cumulus.grid").string(), albedo, phase);
}

const std::string kWhite = R"(<rgb name="albedo" value="0.99, 0.98, 0.97"/>)";

/// A coloured albedo over [-1, 1]^3, different in each of 4 x 3 x 5 texels.
std::string albedoGrid(const TemporaryFolder& folder) {
    Volume volume;
    volume.channels = 3;
    volume.color.resolution = {4, 3, 5};
    for (int i = 0; i < 3 * 4 * 3 * 5; ++i) volume.color.values.push_back(0.5f + 0.5f * float(i * 37 % 60) / 60.0f);
    writeVolume(folder.path() / "albedo.vol", volume);
    return fmt::format(R"(<volume name="albedo" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>)",
                       (folder.path() / "albedo.vol").string());
}

/// A ball of 80 triangles of unit radius, with smooth vertex normals unless `flat`.
std::string ball(const TemporaryFolder& folder, bool flat, const std::string& transform, const std::string& content) {
    std::string text;
    const std::vector<glm::vec3> vertices = icosphere(1);
    for (const glm::vec3& v : vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (std::size_t i = 1; i + 2 <= vertices.size(); i += 3) text += fmt::format("f {} {} {}\n", i, i + 1, i + 2);
    return fmt::format(R"(<shape type="obj"><string name="filename" value="{}"/>
    <boolean name="face_normals" value="{}"/><transform name="to_world">{}</transform>{}</shape>)",
                       folder.write("ball.obj", text).string(), flat, transform, content);
}

const std::string kTwoSided = R"(<bsdf type="twosided"><bsdf type="diffuse">
    <rgb name="reflectance" value="0.3, 0.6, 0.8"/></bsdf></bsdf>)";
const std::string kTwoSidedMesh =
    R"(<emitter type="area"><rgb name="radiance" value="7, 6, 5"/><boolean name="two_sided" value="true"/></emitter>)";
const std::string kMeshLight = R"(<emitter type="area"><rgb name="radiance" value="7, 6, 5"/></emitter>)";

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
        {"starry sky, cloud, sun", compiled(kFloor + gradientSky(kStars) + kSun + isotropicCloud)},
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
    std::ranges::move(skyScenes(size), std::back_inserter(scenes));
    std::ranges::move(phaseScenes(size), std::back_inserter(scenes));
    std::ranges::move(texturedScenes(folder, size), std::back_inserter(scenes));
    return scenes;
}

}  // namespace parhelion::test
