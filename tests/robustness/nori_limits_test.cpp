// Skies and clouds in Nori's dialect have the limits of those in Mitsuba's, by their own names.
#include <gtest/gtest.h>

#include "support/bad_text.h"
#include "support/nori_text.h"

namespace parhelion::test {
namespace {

std::string skyWith(const std::string& properties) {
    return noriSceneOf("<emitter type=\"infinite\">" + properties + "</emitter>");
}

std::string cloudOf(const std::string& property) {
    return noriSceneOf(
        "<mesh type=\"cube\"><medium type=\"heterogeneous\"><float name=\"sigmaA\" value=\"1\"/>"
        "<float name=\"sigmaS\" value=\"2\"/>" +
        property + "</medium></mesh>");
}

std::vector<BadText> badSkiesAndClouds() {
    const auto skyOf = [](const std::string& density, const std::string& size) {
        return skyWith("<float name=\"starDensity\" value=\"" + density + "\"/><float name=\"starSize\" value=\"" +
                       size + "\"/>");
    };
    return {
        // 20000 stars
        {"StarsAllOverTheSky", skyOf("@@1591.55", "1"), {"a tenth of the sky", "got 0.381", "starSize"}},
        {"StarsJustTooWide", skyOf("@@16.8", "5"), {"a tenth of the sky", "got 0.1"}},
        {"TooManyStars", skyOf("@@1e6", "0.01"), {"\"starDensity\" must be at most 20860 per steradian"}},
        {"StarsBeyondCounting", skyOf("@@1e30", "0.001"), {"starDensity", "262144 stars"}},
        {"PointStars", skyOf("1", "@@0"), {"[0.001, 10] degrees", "got 0"}},
        {"AxisThatUnderflows", skyWith("<vector name=\"axis\" value=\"@@1e-200 0 0\"/>"), {"axis", "must not be zero"}},
        {"FineCloud", cloudOf("<integer name=\"bakeResolution\" value=\"@@1025\"/>"), {"[1, 1024]", "got 1025"}},
        {"BusyCloud", cloudOf("<float name=\"noiseScale\" value=\"@@257\"/>"), {"(0, 256]", "got 257"}},
    };
}

class NoriLimit : public testing::TestWithParam<BadText> {};

TEST_P(NoriLimit, IsThatOfMitsubasDialect) { expectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(SkiesAndClouds, NoriLimit, testing::ValuesIn(badSkiesAndClouds()), nameOfBadText);

}  // namespace
}  // namespace parhelion::test
