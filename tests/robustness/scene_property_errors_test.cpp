// Plugins and properties that are unknown, of the wrong type or out of range.
#include <gtest/gtest.h>

#include "support/bad_text.h"

namespace parhelion::test {
namespace {

std::vector<BadText> badValues() {
    return {
        {"UnknownProperty",
         sphereOf("@@<float name=\"raduis\" value=\"1\"/>"),
         {"unknown property \"raduis\"", "did you mean \"radius\"?", "center"}},
        {"CamelCaseInVersionThree", sphereOf("@@<boolean name=\"flipNormals\" value=\"true\"/>"), {"flip_normals"}},
        {"PropertyTwice",
         sphereOf("<float name=\"radius\" value=\"1\"/>\n@@<float name=\"radius\" value=\"2\"/>"),
         {"given twice", "scene.xml:3:1"}},
        {"WrongType", sphereOf("@@<string name=\"radius\" value=\"1\"/>"), {"must be a <float>", "got <string>"}},
        {"FloatForInteger", integratorOf("@@<float name=\"max_depth\" value=\"3\"/>"), {"<integer>", "got <float>"}},
        {"NumberWithUnit", sphereOf("<float name=\"radius\" value=\"@@1m\"/>"), {"finite number", "1m"}},
        {"NotANumber", sphereOf("<float name=\"radius\" value=\"@@nan\"/>"), {"finite number", "nan"}},
        {"BeyondDouble", sphereOf("<float name=\"radius\" value=\"@@1e999\"/>"), {"finite number", "1e999"}},
        {"NegativeRadius", sphereOf("<float name=\"radius\" value=\"@@-1\"/>"), {"\"radius\" must be in (0", "got -1"}},
        {"BooleanIsNumber", sphereOf("<boolean name=\"flip_normals\" value=\"@@1\"/>"), {"true", "false", "\"1\""}},
        {"PointWithTwoCoordinates",
         sphereOf("@@<point name=\"center\" x=\"1\" y=\"2\"/>"),
         {"needs an attribute \"z\""}},
        {"PointInBothForms", sphereOf("<point name=\"center\" value=\"1\" @@x=\"2\"/>"), {"not both"}},
        {"PointWithTwoNumbers", sphereOf("<point name=\"center\" value=\"@@1, 2\"/>"), {"three numbers"}},
    };
}

std::vector<BadText> badSurfaces() {
    return {
        {"ColorWithTwoNumbers", diffuseOf("<rgb name=\"reflectance\" value=\"@@0.1, 0.2\"/>"), {"three numbers"}},
        {"BadHexColor", diffuseOf("<rgb name=\"reflectance\" value=\"@@#ff00\"/>"), {"#rrggbb"}},
        {"WavelengthList",
         diffuseOf("<spectrum name=\"reflectance\" value=\"@@400:0.1, 700:0.2\"/>"),
         {"wavelength", "<rgb>"}},
        {"ReflectanceAboveOne",
         diffuseOf("<rgb name=\"reflectance\" value=\"@@0.5, 1.25, 0\"/>"),
         {"[0, 1]", "got 1.25"}},
        {"UnknownPlugin",
         sceneOf("<shape type=\"@@spere\"/>"),
         {"\"spere\" is not supported", "did you mean \"sphere\"?"}},
        {"KnownToMitsubaOnly", sceneOf("<shape type=\"@@cylinder\"/>"), {"obj, rectangle, cube, sphere"}},
        {"SunAndSky", sceneOf("<emitter type=\"@@sunsky\"/>"), {"constant, directional, envmap, point, sky"}},
        {"GlossySurface", sphereOf("<bsdf type=\"@@roughconductor\"/>"), {"diffuse, null, twosided"}},
        {"TwoSurfaces", sphereOf("<bsdf type=\"diffuse\"/>@@<bsdf type=\"null\"/>"), {"only one <bsdf>"}},
        {"TwoSidedNull", sphereOf("<bsdf type=\"twosided\">@@<bsdf type=\"null\"/></bsdf>"), {"diffuse", "null"}},
        {"PhaseInShape", sphereOf("@@<phase type=\"hg\"/>"), {"<phase> is not allowed here"}},
    };
}

std::vector<BadText> badStrategies() {
    const auto directOf = [](const std::string& properties) {
        return sceneOf("", "<integrator type=\"direct\">" + properties + "</integrator>" + kSensor);
    };
    return {
        {"UnknownStrategy", directOf("<string name=\"strategy\" value=\"@@brdf\"/>"), {"bsdf", "emitter", "mis"}},
        {"StrategyAndCounts",
         directOf("<string name=\"strategy\" value=\"@@mis\"/><integer name=\"bsdf_samples\" value=\"2\"/>"),
         {"not both"}},
        {"ShadingAndCounts",
         directOf("<integer name=\"shading_samples\" value=\"@@2\"/><integer name=\"bsdf_samples\" value=\"2\"/>"),
         {"not both"}},
        {"NoSampleAtAll",
         directOf("<integer name=\"bsdf_samples\" value=\"0\"/><integer name=\"emitter_samples\" value=\"@@0\"/>"),
         {"must be at least 1"}},
        {"NegativeSamples", directOf("<integer name=\"emitter_samples\" value=\"@@-1\"/>"), {"[0, 1000000]", "got -1"}},
        {"DirectHasNoDepth", directOf("@@<integer name=\"max_depth\" value=\"3\"/>"), {"unknown property"}},
        {"TooManyDepthLayers", integratorOf("<integer name=\"depth_layers\" value=\"@@65\"/>"), {"[0, 64]", "got 65"}},
        {"StrategyOfAPath", integratorOf("@@<string name=\"strategy\" value=\"mis\"/>"), {"unknown property"}},
    };
}

std::vector<BadText> badLights() {
    return {
        {"NegativeRadiance",
         sceneOf("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"@@1 -1 1\"/></emitter>"),
         {"got -1"}},
        {"TwoSkies",
         sceneOf("<emitter type=\"constant\"/>\n@@<emitter type=\"constant\"/>"),
         {"only one emitter", "scene.xml:2:1"}},
        {"SkyBesidesConstant",
         sceneOf("<emitter type=\"constant\"/>\n@@<emitter type=\"sky\"/>"),
         {"only one emitter", "scene.xml:2:1"}},
        {"AreaLightWithoutShape", sceneOf("@@<emitter type=\"area\"/>"), {"nested in a <shape>"}},
        {"LightOnNullSurface",
         sceneOf("@@<shape type=\"sphere\"><bsdf type=\"null\"/><emitter type=\"area\"/></shape>"),
         {"null"}},
        {"ZeroDirection",
         sceneOf("<emitter type=\"directional\"><vector name=\"direction\" value=\"@@0 0 0\"/></emitter>"),
         {"must not be zero"}},
        {"DirectionInBothForms",
         sceneOf("<emitter type=\"directional\"><vector name=\"direction\" value=\"0 0 1\"/>@@<transform "
                 "name=\"to_world\"/></emitter>"),
         {"not both"}},
    };
}

/// A sky around the part that is wrong.
std::string skyOf(const std::string& content) { return sceneOf("<emitter type=\"sky\">\n" + content + "\n</emitter>"); }

std::vector<BadText> badSkies() {
    return {
        {"NegativeWidth", skyOf("<float name=\"width\" value=\"@@-0.1\"/>"), {"\"width\" must be in [0", "got -0.1"}},
        {"NegativePower", skyOf("<float name=\"power\" value=\"@@-1\"/>"), {"\"power\" must be in [0", "got -1"}},
        {"InfiniteOffset", skyOf("<float name=\"offset\" value=\"@@inf\"/>"), {"finite"}},
        {"ZeroAxis", skyOf("<vector name=\"axis\" value=\"@@0 0 0\"/>"), {"must not be zero"}},
        {"NegativeSkyRadiance", skyOf("<rgb name=\"bottom\" value=\"@@1 -1 1\"/>"), {"got -1"}},
        {"NegativeStarRadiance", skyOf("<rgb name=\"star_radiance\" value=\"@@-2\"/>"), {"got -2"}},
        {"NegativeStarDensity", skyOf("<float name=\"star_density\" value=\"@@-3\"/>"), {"star_density", "got -3"}},
        {"PointStars",
         skyOf("<float name=\"star_size\" value=\"@@0\"/><float name=\"star_density\" value=\"1\"/>"),
         {"[0.001, 10] degrees", "got 0"}},
        {"HugeStars", skyOf("<float name=\"star_size\" value=\"@@11\"/>"), {"[0.001, 10] degrees", "got 11"}},
        {"TooManyStars",
         skyOf("<float name=\"star_density\" value=\"@@1e6\"/><float name=\"star_size\" value=\"0.01\"/>"),
         {"at most 20860 per steradian", "got 1000000"}},
        {"StarsAllOverTheSky",
         skyOf("<float name=\"star_density\" value=\"@@100\"/><float name=\"star_size\" value=\"5\"/>"),
         {"a tenth of the sky", "got 0.598"}},
        {"NegativeSeed", skyOf("<integer name=\"star_seed\" value=\"@@-1\"/>"), {"star_seed", "got -1"}},
        {"UnknownSkyProperty", skyOf("@@<float name=\"stars\" value=\"1\"/>"), {"unknown property \"stars\"", "star_"}},
    };
}

std::vector<BadText> badMedia() {
    return {
        {"MisspeltScattering", mediumOf("@@<rgb name=\"sigma_sc\" value=\"1\"/>"), {"did you mean \"sigma_s\"?"}},
        {"MediumWithoutRole", sphereOf("@@<medium type=\"homogeneous\"/>"), {"interior", "exterior"}},
        {"NegativeExtinction",
         mediumOf("<float name=\"sigma_t\" value=\"@@-2\"/>"),
         {"\"sigma_t\" must be in [0", "got -2"}},
        {"NanExtinction", mediumOf("<rgb name=\"sigma_t\" value=\"@@1 nan 1\"/>"), {"finite", "nan"}},
        {"NegativeScale", mediumOf("<float name=\"scale\" value=\"@@-1\"/>"), {"scale", "got -1"}},
        {"AlbedoAboveOne", mediumOf("<float name=\"albedo\" value=\"@@1.5\"/>"), {"[0, 1]", "got 1.5"}},
        {"AnisotropyOfOne",
         mediumOf("<phase type=\"hg\"><float name=\"g\" value=\"@@1\"/></phase>"),
         {"(-1, 1)", "got 1"}},
        {"UnknownPhase", mediumOf("<phase type=\"@@sggx\"/>"), {"isotropic, hg, dual_hg"}},
        {"TwoPhases", mediumOf("<phase type=\"hg\"/>@@<phase type=\"hg\"/>"), {"only one <phase>"}},
        {"MixedCoefficients",
         mediumOf("<float name=\"sigma_s\" value=\"1\"/><float name=\"albedo\" value=\"@@0.5\"/>"),
         {"mixes"}},
        {"VolumeWithUnknownName", mediumOf("@@<volume name=\"sigma_x\" type=\"gridvolume\"/>"), {"sigma_x", "sigma_t"}},
    };
}

/// A medium with a phase function of the given type and content.
std::string phaseOf(const std::string& type, const std::string& content) {
    return mediumOf("<phase type=\"" + type + "\">" + content + "</phase>");
}

std::string tableOf(const std::string& values) {
    return phaseOf("tabphase", "<string name=\"values\" value=\"@@" + values + "\"/>");
}

std::vector<BadText> badPhases() {
    const std::string lobes = "<float name=\"g1\" value=\"0.8\"/><float name=\"g2\" value=\"-0.2\"/>";
    const std::string weight = "<float name=\"weight\" value=\"0.5\"/>", lobe = "<phase type=\"hg\"/>";
    return {
        {"LobeWithoutWeight",
         mediumOf("@@<phase type=\"dual_hg\">" + lobes + "</phase>"),
         {"needs <float name=\"weight\">"}},
        {"WeightAboveOne",
         phaseOf("dual_hg", lobes + "<float name=\"weight\" value=\"@@1.5\"/>"),
         {"[0, 1]", "got 1.5"}},
        {"SecondLobeBeyondOne",
         phaseOf("dual_hg", weight + "<float name=\"g1\" value=\"0\"/><float name=\"g2\" value=\"@@-1\"/>"),
         {"(-1, 1)", "got -1"}},
        {"BlendOfOne",
         mediumOf("@@<phase type=\"blendphase\">" + weight + lobe + "</phase>"),
         {"two <phase>", "got 1"}},
        {"BlendWithoutWeight", mediumOf("@@<phase type=\"blendphase\">" + lobe + lobe + "</phase>"), {"weight"}},
        {"BlendWithWeightOutside",
         phaseOf("blendphase", lobe + lobe + "<float name=\"weight\" value=\"@@-0.5\"/>"),
         {"[0, 1]", "got -0.5"}},
        {"BlendOfOthers",
         phaseOf("blendphase", weight + lobe + "@@<phase type=\"rayleigh\"/>"),
         {"isotropic or hg can be blended"}},
        {"BlendOfItself",
         mediumOf("<phase type=\"blendphase\" id=\"p\">" + weight + lobe + "@@<ref id=\"p\"/></phase>"),
         {""}},
        {"TableWithoutValues", mediumOf("@@<phase type=\"tabphase\"/>"), {"needs <string name=\"values\">"}},
        {"TableOfOne", tableOf("1"), {"2 to 65536", "got 1"}},
        {"NegativeTable", tableOf("1, -2, 3"), {">= 0", "got -2 as number 2"}},
        {"NanInTable", tableOf("1, nan"), {"finite"}},
        {"EmptyTable", tableOf("0 0 0"), {"zero everywhere"}},
        {"RayleighHasNoParameter",
         phaseOf("rayleigh", "@@<float name=\"g\" value=\"0\"/>"),
         {"unknown property \"g\""}},
    };
}

std::vector<BadText> badGrids() {
    return {
        {"MissingGridFile", gridOf("<string name=\"filename\" value=\"@@no.vol\"/>"), {"no.vol", "not found"}},
        {"GridWithoutFile",
         mediumOf("@@<volume name=\"sigma_t\" type=\"gridvolume\"/>", "heterogeneous"),
         {"needs <string name=\"filename\">"}},
        {"UnnamedGridFile", gridOf("<string name=\"filename\" value=\"@@\"/>"), {"must name a file"}},
        {"NearestFilter", gridOf("<string name=\"filter_type\" value=\"@@nearest\"/>"), {"trilinear"}},
        {"RepeatingGrid", gridOf("<string name=\"wrap_mode\" value=\"@@repeat\"/>"), {"clamp"}},
        {"DamagedGridFile",
         gridOf("<string name=\"filename\" value=\"bad.vol\"/>"),
         {"bad.vol"},
         {{"bad.vol", "VOL\3 and no more"}}},
    };
}

std::vector<BadText> badCameras() {
    return {
        {"ZeroFov", cameraOf("<float name=\"fov\" value=\"@@0\"/>"), {"(0, 180)", "got 0"}},
        {"FlatFov", cameraOf("<float name=\"fov\" value=\"@@180\"/>"), {"(0, 180)"}},
        {"UnknownFovAxis",
         cameraOf("<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"@@z\"/>"),
         {"diagonal"}},
        {"FovAxisAlone", cameraOf("<string name=\"fov_axis\" value=\"@@x\"/>"), {"needs a \"fov\""}},
        {"FovAndLens",
         cameraOf("<float name=\"fov\" value=\"40\"/><string name=\"focal_length\" value=\"@@50mm\"/>"),
         {"not both"}},
        {"BadLens", cameraOf("<string name=\"focal_length\" value=\"@@long\"/>"), {"50mm", "long"}},
        {"ScaledCamera",
         cameraOf("@@<transform name=\"to_world\"><scale value=\"2\"/></transform>"),
         {"must not scale"}},
        {"ClipsCrossed",
         cameraOf("<float name=\"near_clip\" value=\"@@5\"/><float name=\"far_clip\" value=\"1\"/>"),
         {"less than"}},
        {"ShutterCrossed",
         cameraOf("<float name=\"shutter_open\" value=\"@@2\"/><float name=\"shutter_close\" value=\"1\"/>"),
         {"at most"}},
        {"UnknownSensor", sceneOf("", kIntegrator + "<sensor type=\"@@thinlens\"/>"), {"perspective"}},
    };
}

std::vector<BadText> badFilmsAndIntegrators() {
    return {
        {"UnknownFilm", cameraOf("<film type=\"@@specfilm\"/>"), {"hdrfilm"}},
        {"EmptyFilm", filmOf("<integer name=\"width\" value=\"@@0\"/>"), {"[1, 32768]", "got 0"}},
        {"CropOutside",
         filmOf("<integer name=\"crop_offset_x\" value=\"@@700\"/><integer name=\"crop_width\" value=\"100\"/>"),
         {"inside the film", "768"}},
        {"CropOffsetAlone", filmOf("<integer name=\"crop_offset_y\" value=\"@@1\"/>"), {"1 + 576"}},
        {"UnknownFilter", filmOf("<rfilter type=\"@@mitchell\"/>"), {"box, tent, gaussian"}},
        {"RadiusOfBox",
         filmOf("<rfilter type=\"box\">@@<float name=\"radius\" value=\"1\"/></rfilter>"),
         {"unknown property \"radius\""}},
        {"UnknownFileFormat", filmOf("<string name=\"file_format\" value=\"@@png\"/>"), {"openexr"}},
        {"NoSamples",
         cameraOf("<sampler type=\"independent\"><integer name=\"sample_count\" value=\"@@0\"/></sampler>"),
         {"got 0"}},
        {"UnknownSampler", cameraOf("<sampler type=\"@@sobol\"/>"), {"independent"}},
        {"HiddenEmitters", integratorOf("<boolean name=\"hide_emitters\" value=\"@@true\"/>"), {"hide_emitters"}},
        {"DepthBelowMinusOne", integratorOf("<integer name=\"max_depth\" value=\"@@-2\"/>"), {"[-1", "got -2"}},
        {"RouletteAtZero", integratorOf("<integer name=\"rr_depth\" value=\"@@0\"/>"), {"got 0"}},
        {"AovIntegrator",
         sceneOf("", "@@<integrator type=\"aov\"/>" + kSensor),
         {"not supported", "albedo, normal and depth"}},
        {"UnknownIntegrator", sceneOf("", "<integrator type=\"@@ptracer\"/>" + kSensor), {"path, volpath"}},
        {"EmptyMoment", sceneOf("", "@@<integrator type=\"moment\"/>" + kSensor), {"nested <integrator>"}},
        {"MomentOfAMoment",
         sceneOf("", "<integrator type=\"moment\">@@<integrator type=\"moment\"/></integrator>" + kSensor),
         {"cannot hold another \"moment\""}},
        {"SpectralMisOfVolpath",
         integratorOf("@@<boolean name=\"use_spectral_mis\" value=\"true\"/>"),
         {"unknown property"}},
    };
}

class ScenePropertyError : public testing::TestWithParam<BadText> {};

TEST_P(ScenePropertyError, NamesTheCauseAndItsPlace) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Values, ScenePropertyError, testing::ValuesIn(badValues()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Surfaces, ScenePropertyError, testing::ValuesIn(badSurfaces()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Lights, ScenePropertyError, testing::ValuesIn(badLights()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Strategies, ScenePropertyError, testing::ValuesIn(badStrategies()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Skies, ScenePropertyError, testing::ValuesIn(badSkies()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Media, ScenePropertyError, testing::ValuesIn(badMedia()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Phases, ScenePropertyError, testing::ValuesIn(badPhases()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Grids, ScenePropertyError, testing::ValuesIn(badGrids()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Cameras, ScenePropertyError, testing::ValuesIn(badCameras()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(FilmsAndIntegrators, ScenePropertyError, testing::ValuesIn(badFilmsAndIntegrators()),
                         nameOfBadText);

}  // namespace
}  // namespace parhelion::test
