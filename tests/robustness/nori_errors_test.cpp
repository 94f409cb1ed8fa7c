// Scenes in Nori's dialect that break its rules: a located message each, and never a crash.
#include <gtest/gtest.h>

#include <random>

#include "support/bad_text.h"
#include "support/nori_text.h"
#include "support/paths.h"
#include "support/run_program.h"

namespace parhelion::test {
namespace {

std::string meshOf(const std::string& content) {
    return noriSceneOf("<mesh type=\"rectangle\">\n" + content + "</mesh>");
}

std::string boundedBy(const std::string& content, const std::string& type = "homogeneous") {
    return noriSceneOf("<mesh type=\"cube\">@@<medium type=\"" + type + "\">" + content + "</medium></mesh>");
}

std::string inMedium(const std::string& content, const std::string& type = "homogeneous") {
    return noriSceneOf("<mesh type=\"cube\"><medium type=\"" + type + "\">" + content + "</medium></mesh>");
}

std::string stepOf(const std::string& step) { return meshOf("<transform name=\"toWorld\">" + step + "</transform>"); }

std::string emitterOf(const std::string& type, const std::string& content) {
    return noriSceneOf("<emitter type=\"" + type + "\">" + content + "</emitter>");
}

std::string cameraWith(const std::string& content) {
    return noriSceneOf("", kNoriIntegrator + "<camera type=\"perspective\">" + content + "</camera>");
}

const std::string kSigmas = R"(<float name="sigmaA" value="1"/><float name="sigmaS" value="2"/>)";

std::vector<BadText> badDocuments() {
    return {
        {"TestRoot", "@@<test type=\"ttest\"/>", {"<test>", "<scene>"}},
        {"SceneAttribute", "<scene @@id=\"x\">" + kNoriIntegrator + kNoriCamera + "</scene>", {"id"}},
        {"UnknownTag", noriSceneOf("@@<meshh type=\"obj\"/>"), {"did you mean \"mesh\"?"}},
        {"TagOfMitsuba", noriSceneOf("@@<shape type=\"obj\"/>"), {"<shape>", "mesh"}},
        {"MisplacedTag", noriSceneOf("@@<bsdf type=\"diffuse\"/>"), {"not allowed inside <scene>"}},
        {"UnknownStep", stepOf("@@<shear value=\"1 0 0\"/>"), {"<shear>", "translate"}},
        {"ExtraAttribute", noriSceneOf("<mesh type=\"rectangle\" @@id=\"x\"/>"), {"no attribute \"id\""}},
        {"MissingType", noriSceneOf("@@<mesh/>"), {"needs an attribute \"type\""}},
        {"MissingValue", meshOf("@@<float name=\"radius\"/>"), {"needs an attribute \"value\""}},
        {"NoCamera", "@@<scene>" + kNoriIntegrator + "<mesh type=\"rectangle\"/></scene>", {"needs one <camera>"}},
        {"NoIntegrator", "@@<scene>" + kNoriCamera + "</scene>", {"needs one <integrator>"}},
        {"TwoCameras", noriSceneOf("", kNoriIntegrator + kNoriCamera + "@@" + kNoriCamera), {"only one <camera>"}},
        {"TwoSamplers",
         noriSceneOf("<sampler type=\"independent\"/>@@<sampler type=\"independent\"/>"),
         {"only one <sampler>"}},
        {"Malformed", "<scene>" + kNoriCamera + "</@@camera></scene>", {"malformed XML"}},
    };
}

std::vector<BadText> badValues() {
    return {
        {"UnknownProperty", meshOf("@@<float name=\"radius\" value=\"1\"/>"), {"unknown property \"radius\""}},
        {"MisspeltProperty", cameraWith("@@<float name=\"fow\" value=\"1\"/>"), {"did you mean \"fov\"?"}},
        {"TwoSpellings",
         inMedium("<float name=\"sigma_a\" value=\"1\"/>@@<float name=\"sigmaA\" value=\"1\"/>"),
         {"given twice"}},
        {"WrongType", cameraWith("@@<string name=\"fov\" value=\"30\"/>"), {"must be a <float>"}},
        {"FloatForInteger", cameraWith("@@<float name=\"width\" value=\"30\"/>"), {"must be a <integer>"}},
        {"ColorOfTwo",
         meshOf("<bsdf type=\"diffuse\"><color name=\"albedo\" value=\"@@1 0\"/></bsdf>"),
         {"three numbers"}},
        {"MitsubasRgb", meshOf("<bsdf type=\"diffuse\">@@<rgb name=\"albedo\" value=\"1\"/></bsdf>"), {"<rgb>"}},
        {"AlbedoAboveOne",
         meshOf("<bsdf type=\"diffuse\"><color name=\"albedo\" value=\"@@1 2 0\"/></bsdf>"),
         {"[0, 1]", "got 2"}},
        {"NanAlbedo", meshOf("<bsdf type=\"diffuse\"><color name=\"albedo\" value=\"@@nan 0 0\"/></bsdf>"), {"nan"}},
        {"InfiniteRadiance",
         meshOf("<emitter type=\"area\"><color name=\"radiance\" value=\"@@inf 0 0\"/></emitter>"),
         {"inf"}},
        {"ZeroWidth", cameraWith("<integer name=\"width\" value=\"@@0\"/>"), {"width", "got 0"}},
        {"FlatFov", cameraWith("<float name=\"fov\" value=\"@@180\"/>"), {"fov", "180"}},
    };
}

std::vector<BadText> badTransformsAndFiles() {
    return {
        {"ScalingCamera",
         cameraWith("@@<transform name=\"toWorld\"><scale value=\"2 2 2\"/></transform>"),
         {"must not scale"}},
        {"ScaleOfOneNumber", stepOf("<scale value=\"@@2\"/>"), {"three numbers"}},
        {"TranslateByNan", stepOf("<translate value=\"@@0 nan 0\"/>"), {"finite"}},
        {"SingularScale", meshOf("@@<transform name=\"toWorld\"><scale value=\"1 0 1\"/></transform>"), {"singular"}},
        {"ShortMatrix", stepOf("<matrix value=\"@@1 0 0 0 1 0 0 0 1\"/>"), {"16 numbers", "got 9"}},
        {"RotationWithoutAxis", stepOf("@@<rotate angle=\"90\"/>"), {"axis"}},
        {"RotationAboutNothing", stepOf("@@<rotate angle=\"90\" axis=\"0 0 0\"/>"), {"axis must not be zero"}},
        {"MissingMesh",
         noriSceneOf("<mesh type=\"obj\"><string name=\"filename\" value=\"@@no.obj\"/></mesh>"),
         {"no.obj", "not found"}},
        {"MeshWithoutFile", noriSceneOf("@@<mesh type=\"obj\"/>"), {"filename"}},
        {"BrokenMesh",
         noriSceneOf("<mesh type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></mesh>"),
         {"x"},
         {{"m.obj", "v 0 0 0\nv 0 1 @@x\nv 1 0 0\nf 1 2 3\n"}}},
        {"MissingTexture",
         meshOf("<bsdf type=\"textured_diffuse\"><string name=\"filename\" value=\"@@no.exr\"/></bsdf>"),
         {"no.exr", "not found"}},
        {"MissingMap", emitterOf("envmap", "<string name=\"filename\" value=\"@@no.hdr\"/>"), {"no.hdr", "not found"}},
    };
}

std::vector<BadText> badPlugins() {
    const std::string constant = "<emitter type=\"constant\"/>";
    return {
        {"UnknownMesh", noriSceneOf("<mesh type=\"@@ply\"/>"), {"\"ply\" is not supported", "obj"}},
        {"UnknownBsdf", meshOf("<bsdf type=\"@@dielectric\"/>"), {"\"dielectric\" is not supported", "diffuse"}},
        {"UnknownIntegrator",
         noriSceneOf("", "<integrator type=\"@@path_mats\"/>" + kNoriCamera),
         {"\"path_mats\" is not supported", "path_mis", "path_mis_vol", "direct"}},
        {"UnknownStrategy",
         noriSceneOf(
             "", "<integrator type=\"direct\"><string name=\"strategy\" value=\"@@both\"/></integrator>" + kNoriCamera),
         {"both", "mis"}},
        {"UnknownSampler", noriSceneOf("<sampler type=\"@@sobol\"/>"), {"\"sobol\" is not supported"}},
        {"UnknownCamera", noriSceneOf("", kNoriIntegrator + "<camera type=\"@@thinlens\"/>"), {"perspective"}},
        {"UnknownEmitter", emitterOf("@@spot", ""), {"\"spot\" is not supported", "infinite"}},
        {"UnknownMedium", inMedium(kSigmas, "@@cloudy"), {"\"cloudy\" is not supported", "heterogeneous"}},
        {"UnknownPhase", inMedium(kSigmas + "<phase type=\"@@schlick\"/>"), {"\"schlick\"", "dual_hg"}},
        {"MitchellFilter", cameraWith("<rfilter type=\"@@mitchell\"/>"), {"\"mitchell\" is not supported", "gaussian"}},
        {"AreaLightOfItsOwn", noriSceneOf("@@<emitter type=\"area\"/>"), {"nested in a <mesh>"}},
        {"TwoSurroundings", noriSceneOf(constant + "@@" + constant), {"only one emitter may surround"}},
        {"DirectionZero", emitterOf("directional", "<vector name=\"direction\" value=\"@@0 0 0\"/>"), {"zero"}},
        {"TwoNamesOfOneValue",
         emitterOf("directional", "<float name=\"radiance\" value=\"1\"/><float name=\"irradiance\" value=\"@@1\"/>"),
         {"not both"}},
        {"ScaledMap",
         emitterOf("envmap", "@@<transform name=\"toWorld\"><scale value=\"2 2 2\"/></transform>"),
         {"must not scale"}},
        {"NullLight",
         noriSceneOf("@@<mesh type=\"cube\"><bsdf type=\"null\"/><emitter type=\"area\"/></mesh>"),
         {"emit"}},
    };
}

std::vector<BadText> badMedia() {
    return {
        {"WithoutCoefficients", boundedBy(""), {"sigmaA and sigmaS"}},
        {"HalfOfThem", boundedBy("<float name=\"sigmaA\" value=\"1\"/>"), {"\"sigmaS\" is missing"}},
        {"MixedForms",
         inMedium("<float name=\"sigmaS\" value=\"@@1\"/><float name=\"albedo\" value=\"1\"/>"),
         {"mixes"}},
        {"TotalIsNoSum", inMedium(kSigmas + "<float name=\"sigmaT\" value=\"@@3.1\"/>"), {"sigmaA + sigmaS"}},
        {"NegativeSigma",
         inMedium("<float name=\"sigmaA\" value=\"@@-1\"/><float name=\"sigmaS\" value=\"1\"/>"),
         {"-1"}},
        {"FreeWithoutBounds",
         noriSceneOf("@@<medium type=\"homogeneous\">" + kSigmas + "</medium>"),
         {"boundsMin and boundsMax"}},
        {"BoundsInsideOut",
         noriSceneOf(
             "<medium type=\"homogeneous\">" + kSigmas +
             "<point name=\"boundsMin\" value=\"0 0 0\"/><point name=\"boundsMax\" value=\"@@1 -1 1\"/></medium>"),
         {"above \"boundsMin\""}},
        {"WithoutDensity", boundedBy(kSigmas, "heterogeneous"), {"needs a density"}},
        {"MissingDensity",
         inMedium(kSigmas + "<string name=\"filename\" value=\"@@no.grid\"/>", "heterogeneous"),
         {"no.grid", "not found"}},
        {"BrokenDensity",
         inMedium(kSigmas + "<string name=\"filename\" value=\"x.vol\"/>", "heterogeneous"),
         {"x.vol"},
         {{"x.vol", "VOL\x03 and nothing more"}}},
        {"CloudOfNoVoxels",
         inMedium(kSigmas + "<integer name=\"bakeResolution\" value=\"@@0\"/>", "heterogeneous"),
         {"bakeResolution"}},
        {"LobeWeight",
         inMedium(kSigmas + "<phase type=\"dual_hg\"><float name=\"g1\" value=\"0.5\"/><float name=\"g2\" value=\"0\"/>"
                            "<float name=\"weight\" value=\"@@1.5\"/></phase>"),
         {"[0, 1]"}},
        {"PhaseWithoutG", inMedium(kSigmas + "@@<phase type=\"hg\"/>"), {"needs <float name=\"g\">"}},
        {"PhaseBeyondOne",
         inMedium(kSigmas + "<phase type=\"hg\"><float name=\"g\" value=\"@@1\"/></phase>"),
         {"(-1, 1)"}},
    };
}

class NoriRefusal : public testing::TestWithParam<BadText> {};

TEST_P(NoriRefusal, NamesThePlaceAndWhatIsAllowed) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Documents, NoriRefusal, testing::ValuesIn(badDocuments()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Values, NoriRefusal, testing::ValuesIn(badValues()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(TransformsAndFiles, NoriRefusal, testing::ValuesIn(badTransformsAndFiles()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Plugins, NoriRefusal, testing::ValuesIn(badPlugins()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Media, NoriRefusal, testing::ValuesIn(badMedia()), nameOfBadText);

/// Every tag and most properties of the dialect.
const std::string kGoodScene = R"(<?xml version="1.0" encoding="utf-8"?>
<scene>
  <!-- a cloud over a floor -->
  <integrator type="path_mis_vol"><integer name="maxDepth" value="8"/></integrator>
  <sampler type="independent"><integer name="sampleCount" value="4"/></sampler>
  <camera type="perspective">
    <transform name="toWorld"><lookat origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <float name="fov" value="35"/><integer name="width" value="16"/><integer name="height" value="12"/>
    <rfilter type="tent"><float name="radius" value="1.5"/></rfilter>
  </camera>
  <mesh type="obj">
    <string name="filename" value="t.obj"/>
    <transform name="toWorld"><scale value="2 2 2"/><rotate axis="1 0 0" angle="-90"/>
      <matrix value="1 0 0 0 0 1 0 -1 0 0 1 0 0 0 0 1"/><translate value="0 0 -1"/></transform>
    <bsdf type="textured_diffuse"><string name="filename" value="pair.hdr"/><boolean name="flipV" value="true"/></bsdf>
    <emitter type="area"><color name="radiance" value="1 2 3"/></emitter>
  </mesh>
  <emitter type="infinite"><vector name="axis" value="0 1 0"/><color name="top" value="0.1 0.2 0.4"/></emitter>
  <emitter type="directional"><vector name="direction" value="0 -1 0"/><color name="radiance" value="1 1 1"/></emitter>
  <medium type="heterogeneous">
    <color name="sigma_a" value="0 0.1 0.2"/><float name="sigma_s" value="5"/><float name="detailAmount" value="0.4"/>
    <point name="boundsMin" value="-1 0 -1"/><point name="boundsMax" value="1 2 1"/>
    <phase type="dual_hg"><float name="g1" value="0.8"/><float name="g2" value="-0.2"/>
      <float name="weight" value="0.7"/></phase>
  </medium>
</scene>
)";

/// Reads a damaged scene; anything but a scene or an InputError with a place fails the test.
///
/// @return whether it was accepted.
bool readsOrRefuses(const TemporaryFolder& folder, const std::string& text) {
    try {
        readScene(folder.write("scene.xml", text));
        return true;
    } catch (const InputError& error) {
        EXPECT_FALSE(error.where().file.empty()) << error.what() << "\n" << text;
        return false;
    }
}

class DamagedNoriScene : public testing::Test {
protected:
    void SetUp() override {
        folder_.write("t.obj", kTriangleObj);
        folder_.write("pair.hdr", kPairHdr);
        ASSERT_TRUE(readsOrRefuses(folder_, kGoodScene));
    }

    TemporaryFolder folder_;
};

TEST_F(DamagedNoriScene, EveryTruncationIsRefused) {
    const std::size_t end = kGoodScene.rfind("</scene>") + std::string("</scene>").size();
    for (std::size_t length = 0; length < end; ++length)
        EXPECT_FALSE(readsOrRefuses(folder_, kGoodScene.substr(0, length))) << "at byte " << length;
}

TEST_F(DamagedNoriScene, EveryDamagedByteGivesASceneOrALocatedError) {
    std::mt19937 random(1);
    const auto below = [&random](std::size_t n) {
        return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
    };
    int accepted = 0, refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string text = kGoodScene;
        for (std::size_t changes = 1 + below(2); changes > 0; --changes) {
            const std::size_t at = below(text.size());
            switch (below(4)) {
                case 0:
                    text[at] = static_cast<char>(below(256));
                    break;
                case 1:
                    text.erase(at, 1 + below(4));
                    break;
                case 2:
                    text.insert(at, text.substr(below(text.size()), 1 + below(8)));
                    break;
                default:
                    text[at] = text[below(text.size())];
            }
        }
        ++(readsOrRefuses(folder_, text) ? accepted : refused);
    }
    EXPECT_GT(accepted, 20) << "changes of values and of what is between elements";
    EXPECT_GT(refused, 1000);
}

TEST(NoriProgram, ExitsWith2AndWritesNothing) {
    const TemporaryFolder folder;
    folder.write("scene.xml", noriSceneOf("<mesh type=\"rectangle\" id=\"x\"/>"));
    const auto output = folder.path() / "out.exr";
    const ProgramResult result = runProgram(programFile(), {"render", "scene.xml", "-o", "out.exr"}, folder.path());
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.error.find("scene.xml:2:24: <mesh> has no attribute \"id\""), std::string::npos) << result.error;
    EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(NoriProgram, DefinesHaveNoMeaning) {
    const TemporaryFolder folder;
    const auto scene = folder.write("scene.xml", noriSceneOf(""));
    EXPECT_THROW(readScene(scene, {.defines = {{"spp", "4"}}}), InputError);
}

}  // namespace
}  // namespace parhelion::test
