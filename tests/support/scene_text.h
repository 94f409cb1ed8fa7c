#pragma once

#include <string>

namespace parhelion::test {

/// A small valid Mitsuba scene in pieces, each of which a test may replace: a unit cube of fog under a uniform sky,
/// 16x12 pixels, 4 samples.
struct SceneText {
    std::string start = "";
    std::string integrator = R"(<integrator type="volpath"><integer name="max_depth" value="8"/></integrator>)";
    std::string width = R"(<integer name="width" value="16"/>)";
    std::string emitter = R"(<emitter type="constant"><rgb name="radiance" value="1, 1, 1"/></emitter>)";
    std::string medium = R"(<medium id="fog" type="homogeneous">
    <rgb name="sigma_t" value="2, 2, 2"/>
    <rgb name="albedo" value="0.8, 0.8, 0.8"/>
</medium>)";
    std::string shape = R"(<shape type="cube"><bsdf type="null"/><ref id="fog" name="interior"/></shape>)";
    std::string end = "</scene>\n";

    std::string text() const;
};

/// A medium "fog" whose density comes from a volume file.
std::string gridMedium(const std::string& volumeFile);

}  // namespace parhelion::test
