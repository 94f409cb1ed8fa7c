// Media and phase functions of a scene in Nori's dialect.
#include <gtest/gtest.h>

#include "support/nori_text.h"
#include "support/paths.h"

namespace parhelion::test {
namespace {

MediumDescription readMedium(const std::string& type, const std::string& content) {
    return readNori("<mesh type=\"cube\"><medium type=\"" + type + "\">" + content + "</medium></mesh>").media.at(0);
}

const std::string kCoefficients = R"(<float name="sigma_a" value="1"/><color name="sigma_s" value="1, 3, 0"/>)";

TEST(NoriMedium, TakesCoefficientsPerChannelInBothForms) {
    const MediumDescription parts = readMedium("homogeneous", kCoefficients + R"(<float name="scale" value="2"/>)");
    EXPECT_EQ(parts.sigmaT, glm::dvec3(4, 8, 2));
    EXPECT_EQ(parts.albedo, glm::dvec3(0.5, 0.75, 0));
    EXPECT_EQ(parts.phase.type, PhaseDescription::Type::Isotropic);
    const MediumDescription whole =
        readMedium("homogeneous", R"(<float name="sigmaT" value="3"/><color name="albedo" value="1 0.5 0"/>)");
    EXPECT_EQ(whole.sigmaT, glm::dvec3(3));
    EXPECT_EQ(whole.albedo, glm::dvec3(1, 0.5, 0));
}

TEST(NoriMedium, MakesItsMeshABoundary) {
    const SceneDescription scene =
        readNori("<mesh type=\"cube\"><medium type=\"homogeneous\">" + kCoefficients + "</medium></mesh>");
    EXPECT_EQ(scene.shapes.at(0).bsdf.type, BsdfDescription::Type::Null);
    EXPECT_EQ(scene.shapes.at(0).interior, 0u);
}

TEST(NoriMedium, OfItsOwnFillsItsBounds) {
    const SceneDescription scene =
        readNori("<medium type=\"homogeneous\">" + kCoefficients +
                 R"(<point name="boundsMin" value="0 0 0"/><point name="boundsMax" value="2 4 6"/>
<transform name="toWorld"><translate value="10 0 0"/></transform></medium>)");
    const ShapeDescription& box = scene.shapes.at(0);
    EXPECT_EQ(box.type, ShapeDescription::Type::Cube);
    EXPECT_EQ(box.bsdf.type, BsdfDescription::Type::Null);
    EXPECT_EQ(box.interior, 0u);
    expectNear(moved(box.toWorld, {-1, -1, -1}), {10, 0, 0});
    expectNear(moved(box.toWorld, {1, 1, 1}), {12, 4, 6});
}

TEST(NoriMedium, TakesADensityFileWithBoundsOfItsOwn) {
    const std::string file = test::projectFolder() + "/scenes/two_density.vol";
    const std::string density = "<string name=\"filename\" value=\"" + file + "\"/>";
    const MediumDescription plain = readMedium("heterogeneous", kCoefficients + density);
    ASSERT_TRUE(plain.density);
    EXPECT_EQ(plain.sigmaT, glm::dvec3(2, 4, 1));
    const Volume& volume = plain.density->volume;
    expectNear(moved(plain.density->toWorld, {1, 1, 1}), volume.boundsMax);
    const MediumDescription placed =
        readMedium("heterogeneous", kCoefficients + density +
                                        R"(<float name="densityScale" value="3"/><float name="majorant" value="9"/>
<point name="boundsMin" value="-1 -1 -1"/><point name="boundsMax" value="1 1 3"/>
<transform name="toWorld"><scale value="2 2 2"/></transform>)");
    EXPECT_EQ(placed.sigmaT, glm::dvec3(6, 12, 3));
    expectNear(moved(placed.density->toWorld, {0, 0, 0}), {-2, -2, -2});
    expectNear(moved(placed.density->toWorld, {1, 1, 1}), {2, 2, 6});
}

TEST(NoriMedium, IsAProceduralCloudWithTheBaselinesParameters) {
    const MediumDescription medium = readMedium("heterogeneous", kCoefficients +
                                                                     R"(<float name="detailAmount" value="0.38"/>
<float name="noiseScale" value="2.5"/><float name="warpAmount" value="0.25"/><float name="erosionAmount" value="0.5"/>
<float name="surfaceWidth" value="0.125"/><float name="densityScale" value="0.75"/>
<float name="densityThreshold" value="0.0625"/><integer name="noiseSeed" value="9"/>
<integer name="bakeResolution" value="64"/>)");
    ASSERT_TRUE(medium.density && medium.density->cloud);
    const shared::CloudField& cloud = *medium.density->cloud;
    EXPECT_EQ(cloud.detailAmount, 0.38f);
    EXPECT_EQ(cloud.noiseScale, 2.5f);
    EXPECT_EQ(cloud.warpAmount, 0.25f);
    EXPECT_EQ(cloud.erosionAmount, 0.5f);
    EXPECT_EQ(cloud.surfaceWidth, 0.125f);
    EXPECT_EQ(cloud.densityScale, 0.75f);
    EXPECT_EQ(cloud.densityThreshold, 0.0625f);
    EXPECT_EQ(cloud.noiseSeed, 9u);
    EXPECT_EQ(cloud.resolution, glm::uvec3(64));
    EXPECT_EQ(cloud.modulates, 0u);
    EXPECT_EQ(medium.sigmaT, glm::dvec3(2, 4, 1)) << "the cloud's density scale is within its formula";
}

TEST(NoriMedium, ModulatesAFileByTheCloudsDetail) {
    const std::string file = test::projectFolder() + "/scenes/two_density.vol";
    const MediumDescription medium =
        readMedium("heterogeneous", kCoefficients + "<string name=\"filename\" value=\"" + file +
                                        R"("/><float name="detailAmount" value="0.3"/>)");
    EXPECT_EQ(medium.density->cloud->modulates, 1u);
    EXPECT_EQ(medium.density->cloud->resolution, medium.density->volume.density.resolution());
    EXPECT_EQ(medium.density->cloud->densityScale, 1.0f);
    EXPECT_EQ(medium.density->cloud->densityThreshold, 0.0f);
    EXPECT_GT(medium.density->volume.density.maximum(), 0.0f);
}

TEST(NoriPhase, HasOneOrTwoLobes) {
    const PhaseDescription hg =
        readMedium("homogeneous", kCoefficients + R"(<phase type="hg"><float name="g" value="0.6"/></phase>)").phase;
    EXPECT_EQ(hg.type, PhaseDescription::Type::HenyeyGreenstein);
    EXPECT_EQ(hg.g, 0.6);
    const PhaseDescription dual = readMedium("homogeneous", kCoefficients + R"(<phase type="dual_hg">
<float name="g1" value="0.8"/><float name="g2" value="-0.3"/><float name="weight" value="0.7"/></phase>)")
                                      .phase;
    EXPECT_EQ(dual.type, PhaseDescription::Type::DualHenyeyGreenstein);
    EXPECT_EQ(dual.g, 0.8);
    EXPECT_EQ(dual.g2, -0.3);
    EXPECT_EQ(dual.lobeWeight, 0.7);
}

TEST(NoriMedium, NamesAGridOnlyWhereTheFileHasNames) {
    const std::string medium = "<mesh type=\"cube\"><medium type=\"heterogeneous\">" + kCoefficients +
                               R"(<string name="filename" value="x.vol"/>
<string name="gridName" value="smoke"/></medium></mesh>)";
    const TemporaryFolder folder;
    folder.write("x.vol", "VOL\x03 and nothing more");
    try {
        readScene(folder.write("scene.xml", noriSceneOf(medium)));
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().line, 3) << error.what();
        EXPECT_NE(std::string(error.what()).find("got \"smoke\""), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace parhelion::test
