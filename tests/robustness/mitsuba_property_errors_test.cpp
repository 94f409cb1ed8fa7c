// Properties that Mitsuba documents and that would change the picture, but cannot be honoured here: the reason is
// given.
#include <gtest/gtest.h>

#include "support/bad_text.h"

namespace parhelion::test {
namespace {

std::vector<BadText> refusedProperties() {
    return {
        {"SpectralResponse", cameraOf("@@<texture name=\"srf\" type=\"bitmap\"/>"), {"srf", "spectral"}},
        {"FocusByName", cameraOf("@@<string name=\"focus_distance\" value=\"far\"/>"), {"<float>"}},
        {"BorderByTwoNames",
         filmOf("<boolean name=\"sample_border\" value=\"true\"/>"
                "<boolean name=\"high_quality_edges\" value=\"@@true\"/>"),
         {"not both"}},
        {"NearestVoxel",
         gridOf("<string name=\"filter_type\" value=\"@@nearest\"/>"),
         {"always interpolated", "allowed: trilinear"}},
        {"RepeatedGrid", gridOf("<string name=\"wrap_mode\" value=\"@@repeat\"/>"), {"outside of their box"}},
        {"MirroredAlbedo",
         mediumOf("<volume name=\"albedo\" type=\"gridvolume\"><string name=\"wrap_mode\" "
                  "value=\"@@mirror\"/></volume>",
                  "heterogeneous"),
         {"outside of their box"}},
        {"AreaLightByItself",
         sphereOf("<emitter type=\"area\">@@<transform name=\"to_world\"/></emitter>"),
         {"where its shape is"}},
        {"BackOfItsOwn",
         sphereOf("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/>@@<bsdf type=\"diffuse\"><float "
                  "name=\"reflectance\" value=\"0.1\"/></bsdf></bsdf>"),
         {"back", "front's"}},
        {"ThreeSides",
         sphereOf("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/>"
                  "@@<bsdf type=\"diffuse\"/></bsdf>"),
         {"only two"}},
        {"WeightThatVaries",
         mediumOf("<phase type=\"blendphase\"><phase type=\"hg\"/><phase type=\"hg\"/>@@<volume name=\"weight\" "
                  "type=\"gridvolume\"/></phase>"),
         {"vary in space", "constvolume"}},
        {"ScenePropertyUnknown",
         sceneOf("@@<boolean name=\"embree_use_robust\" value=\"true\"/>"),
         {"no property", "embree_use_robust_intersections"}},
    };
}

class MitsubaPropertyError : public testing::TestWithParam<BadText> {};

TEST_P(MitsubaPropertyError, NamesTheCauseAndItsPlace) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Properties, MitsubaPropertyError, testing::ValuesIn(refusedProperties()), nameOfBadText);

}  // namespace
}  // namespace parhelion::test
