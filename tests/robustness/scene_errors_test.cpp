// Scene files that break the rules of the language.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/bad_text.h"

namespace parhelion::test {
namespace {

std::string moved(const std::string& steps) {
    return sphereOf("@@<transform name=\"to_world\">" + steps + "</transform>");
}
std::string step(const std::string& text) { return sphereOf("<transform name=\"to_world\">" + text + "</transform>"); }

std::vector<BadText> malformedScenes() {
    return {
        {"StrayText", sceneOf("@@hello"), {"text inside <scene>", "hello"}},
        {"MismatchedTags", "<scene version=\"3.0.0\">\n<shape type=\"cube\"></@@bsdf></scene>", {"malformed XML"}},
        {"TwoRoots", "<scene version=\"3.0.0\"/>\n@@<scene version=\"3.0.0\"/>", {"only one element"}},
        {"RootIsNoScene", "@@<shape type=\"cube\"/>", {"<scene version"}},
        {"NoVersion", "@@<scene>" + kIntegrator + kSensor + "</scene>", {"version"}},
        {"FutureVersion", "<scene version=\"@@9.0.0\"></scene>", {"9.0.0"}},
        {"VersionIsNoNumber", "<scene version=\"@@three\"></scene>", {"three"}},
        {"UnknownTag", sceneOf("@@<shap type=\"cube\"/>"), {"<shap>", "did you mean \"shape\"?"}},
        {"MisplacedTag",
         sceneOf("<shape type=\"cube\">@@<translate x=\"1\"/></shape>"),
         {"translate", "inside <shape>"}},
        {"UnknownAttribute", sceneOf("<shape type=\"cube\" @@nmae=\"x\"/>"), {"nmae", "did you mean \"name\"?"}},
        {"RepeatedAttribute", sceneOf("<shape type=\"cube\" @@type=\"cube\"/>"), {"\"type\" twice"}},
        {"MissingType", sceneOf("@@<shape/>"), {"needs an attribute \"type\""}},
        {"MissingValue", sphereOf("@@<float name=\"radius\"/>"), {"needs an attribute \"value\""}},
        {"EndlessNesting",
         [] {
             std::string deep;
             for (int i = 0; i < 62; ++i) deep += "<bsdf type=\"twosided\">";
             deep += "<bsdf type=\"twosided\">@@<bsdf type=\"diffuse\"/></bsdf>";
             for (int i = 0; i < 62; ++i) deep += "</bsdf>";
             return sceneOf("<shape type=\"cube\">" + deep + "</shape>");
         }(),
         {"nested more than 64 deep"}},
        {"NoSensor", "@@<scene version=\"3.0.0\">" + kIntegrator + "</scene>", {"needs one <sensor>"}},
        {"NoIntegrator", "@@<scene version=\"3.0.0\">" + kSensor + "</scene>", {"needs one <integrator>"}},
        {"TwoSensors", sceneOf("", kIntegrator + kSensor + "\n@@" + kSensor), {"only one <sensor>", "scene.xml:3:29"}},
        {"FilmAtSceneLevel", sceneOf("@@<film type=\"hdrfilm\"/>"), {"must be nested"}},
    };
}

std::vector<BadText> badDirectives() {
    return {
        {"UndefinedVariable",
         sphereOf("<default name=\"size\" value=\"1\"/><float name=\"radius\" value=\"@@$siez\"/>"),
         {"$siez", "did you mean \"size\"?"}},
        {"VariableGrowsWithoutBound",
         [] {
             std::string text = "<default name=\"v0\" value=\"0123456789012345\"/>\n";
             for (int i = 1; i < 64; ++i)
                 text += fmt::format("<default name=\"v{}\" value=\"{}$v{}$v{}\"/>\n", i, i == 13 ? "@@" : "", i - 1,
                                     i - 1);
             return sceneOf(text);
         }(),
         {"longer than 65536"}},
    };
}

std::vector<BadText> badIncludes() {
    return {
        {"MissingInclude", sceneOf("<include filename=\"@@no.xml\"/>"), {"no.xml", "not found"}},
        {"IncludesItself", sceneOf("<include filename=\"@@scene.xml\"/>"), {"includes itself"}},
        {"IncludeCycle",
         sceneOf("<include filename=\"b.xml\"/>"),
         {"includes itself"},
         {{"b.xml", "<scene version=\"3.0.0\">\n <include filename=\"@@scene.xml\"/></scene>"}}},
        {"ErrorInIncludedFile",
         sceneOf("<include filename=\"b.xml\"/>"),
         {"did you mean \"radius\"?"},
         {{"b.xml",
           "<scene version=\"3.0.0\">\n\n<shape type=\"sphere\">\n  @@<float name=\"radis\" "
           "value=\"1\"/></shape></scene>"}}},
        {"MalformedIncludedFile",
         sceneOf("<include filename=\"b.xml\"/>"),
         {"malformed XML"},
         {{"b.xml", "<scene version=\"3.0.0\">\n</@@shape>"}}},
        {"VersionOfAnIncludedObject",
         sceneOf("<include filename=\"b.xml\"/>"),
         {"9.0.0"},
         {{"b.xml", "<shape type=\"sphere\" version=\"@@9.0.0\"/>"}}},
        {"NameOfAnIncludedScene",
         sceneOf("<include filename=\"b.xml\" @@name=\"x\"/>"),
         {"one object"},
         {{"b.xml", "<scene version=\"3.0.0\"/>"}}},
        {"PropertyInAnIncludedScene",
         sphereOf("<include filename=\"b.xml\"/>"),
         {"<float> is not allowed inside <scene>"},
         {{"b.xml", "<scene version=\"3.0.0\">@@<float name=\"radius\" value=\"2\"/></scene>"}}},
        {"SwitchInAnIncludedScene",
         sphereOf("<include filename=\"b.xml\"/>"),
         {"not one of <shape>"},
         {{"b.xml", "<scene version=\"3.0.0\">@@<boolean name=\"flip_normals\" value=\"true\"/></scene>"}}},
        {"PathIsNoFolder", sceneOf("<path value=\"@@no/such\"/>"), {"must name a folder"}},
    };
}

std::vector<BadText> badReferences() {
    return {
        {"UndefinedReference",
         sphereOf("<ref id=\"@@whit\"/></shape><bsdf type=\"diffuse\" id=\"white\"/><shape type=\"cube\">"),
         {"no object has the id \"whit\"", "did you mean \"white\"?"}},
        {"DuplicateId",
         sceneOf("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"null\" id=\"@@a\"/>"),
         {"\"a\" is taken already", "scene.xml:2:1"}},
        {"AliasOfNothing", sceneOf("<alias id=\"@@a\" as=\"b\"/>"), {"no object has the id \"a\""}},
        {"AliasTaken", sceneOf("<bsdf type=\"diffuse\" id=\"a\"/><alias id=\"a\" as=\"@@a\"/>"), {"taken already"}},
        {"ReferenceToItself",
         sphereOf("<bsdf type=\"twosided\" id=\"a\">@@<ref id=\"a\"/></bsdf>"),
         {"circular reference: a -> a"}},
        {"ReferencesInACircle",
         sceneOf("<volume type=\"procedural_cloud\" id=\"a\"><ref id=\"b\"/></volume>"
                 "<volume type=\"procedural_cloud\" id=\"b\"><ref id=\"c\"/></volume>"
                 "<volume type=\"procedural_cloud\" id=\"c\">@@<ref id=\"d\"/></volume><alias id=\"a\" as=\"d\"/>"),
         {"circular reference: a -> b -> c -> a"}},
        {"ReferenceOfWrongKind",
         sphereOf("@@<ref id=\"fog\"/>\n</shape><medium type=\"homogeneous\" id=\"fog\"/><shape type=\"cube\">"),
         {"interior", "exterior"}},
    };
}

std::vector<BadText> badTransforms() {
    return {
        {"ZeroScale", moved("<scale x=\"0\"/>"), {"singular"}},
        {"FlatMatrix", moved("<matrix value=\"1 2 3 2 4 6 0 0 1\"/>"), {"singular"}},
        {"OverflowingProduct", moved("<scale value=\"1e200\"/><scale value=\"1e200\"/>"), {"finite"}},
        {"RotationWithoutAxis", step("@@<rotate angle=\"30\"/>"), {"axis must not be zero"}},
        {"RotationWithoutAngle", step("@@<rotate x=\"1\"/>"), {"angle"}},
        {"LookAtItself", step("@@<lookat origin=\"1,2,3\" target=\"1,2,3\" up=\"0,1,0\"/>"), {"differ"}},
        {"LookAlongUp", step("@@<lookat origin=\"0,2,0\" target=\"0,0,0\" up=\"0,1,0\"/>"), {"parallel"}},
        {"LookAtTwoNumbers", step("<lookat origin=\"@@1,2\" target=\"1,2,3\" up=\"0,1,0\"/>"), {"three numbers"}},
        {"MatrixOfTen", step("<matrix value=\"@@1 0 0 0 1 0 0 0 1 0\"/>"), {"16 or 9", "got 10"}},
        {"ProjectiveMatrix", step("<matrix value=\"@@1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>"), {"affine"}},
        {"UnknownStep", step("@@<shear x=\"1\"/>"), {"shear", "translate"}},
        {"UnevenSphere", moved("<scale x=\"2\"/>"), {"all axes alike"}},
    };
}

class SceneError : public testing::TestWithParam<BadText> {};

TEST_P(SceneError, NamesTheCauseAndItsPlace) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Malformed, SceneError, testing::ValuesIn(malformedScenes()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Directives, SceneError, testing::ValuesIn(badDirectives()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Includes, SceneError, testing::ValuesIn(badIncludes()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(References, SceneError, testing::ValuesIn(badReferences()), nameOfBadText);
INSTANTIATE_TEST_SUITE_P(Transforms, SceneError, testing::ValuesIn(badTransforms()), nameOfBadText);

TEST(SceneErrorScale, DoublingIncludesEndInAnError) {
    // 2^40 elements if nothing stopped it; each file includes the next one twice.
    std::map<std::string, std::string> files;
    for (int i = 0; i < 30; ++i) {
        const std::string next = fmt::format("<include filename=\"f{}.xml\"/>", i + 1);
        files[fmt::format("f{}.xml", i)] = "<scene version=\"3.0.0\">" + next + next + "</scene>";
    }
    files["f30.xml"] = "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>";
    EXPECT_THROW(readText(sceneOf("<include filename=\"f0.xml\"/>"), {}, files), InputError);
}

TEST(SceneErrorScale, LongChainsOfReferencesDoNotRecurse) {
    std::string chain;
    for (int i = 0; i < 100'000; ++i)
        chain += fmt::format("<volume type=\"procedural_cloud\" id=\"c{}\"><ref id=\"c{}\"/></volume>", i, i + 1);
    chain += "<volume type=\"procedural_cloud\" id=\"c100000\"/>";
    EXPECT_THROW(readText(sceneOf("<medium type=\"heterogeneous\"><ref id=\"c0\" name=\"sigma_t\"/></medium>" + chain)),
                 InputError);
}

TEST(SceneErrorScale, SubstitutedValuesTogetherAreBounded) {
    std::string body = "<default name=\"v\" value=\"" + std::string(60'000, '1') + "\"/>\n";
    for (int i = 0; i < 1200; ++i) body += fmt::format("<default name=\"w{}\" value=\"$v\"/>\n", i);
    try {
        readText(sceneOf(body));
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("scene.xml:1121:"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("at most 67108864 characters"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace parhelion::test
