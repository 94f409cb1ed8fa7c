#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/render_scene.h"
#include "support/rendering.h"
#include "support/temporary_folder.h"
#include "volume/volume_file.h"

// A heterogeneous medium of constant extinction ends at the world-aligned box of its volume (Mitsuba 3.9.1, in which
// each case below was rendered): light that goes straight through a larger boundary is left exp(-sigma * length).
namespace parhelion {
namespace {

using namespace test;

constexpr double kZ = 5.5;  // a family of 1e-6 over 40 comparisons

struct ExtentCase {
    std::string name;
    std::string sigmaT;                   ///< elements of the medium
    std::string origin = "0.3, 0.4, 20";  ///< of the camera,
    std::string target = "0.3, 0.4, 0";   ///< which looks along -z unless told
    glm::dvec3 opticalDepth{0.5};
    std::string type = "heterogeneous";
    bool onDevice = false;  ///< a kernel to compile; what is cut is the compiler's doing and the same for both

    friend void PrintTo(const ExtentCase& c, std::ostream* stream) { *stream << c.name; }
};

std::string constant(const std::string& value, const std::string& steps) {
    return fmt::format(R"(<volume type="constvolume" name="sigma_t"><rgb name="value" value="{}"/>
<transform name="to_world">{}</transform></volume>)",
                       value, steps);
}

const double kDiagonal = std::sqrt(2.0);
const std::string kTurned =
    R"(<translate x="-0.5" y="-0.5" z="-0.5"/><rotate y="1" angle="45"/>)";  // bounds: 1.414 wide in x and z

const ExtentCase kCases[] = {
    {"UnitCube", constant("0.5", "")},
    {"BesideIt", constant("0.5", ""), "-0.3, 0.4, 20", "-0.3, 0.4, 0", glm::dvec3(0)},
    {"PlainColor",
     R"(<rgb name="sigma_t" value="0.2, 0.5, 0.9"/>)",
     "0.3, 0.4, 20",
     "0.3, 0.4, 0",
     {0.2, 0.5, 0.9},
     "heterogeneous",
     true},
    {"Default", "", "0.3, 0.4, 20", "0.3, 0.4, 0", glm::dvec3(1)},
    {"Scaled", R"(<float name="sigma_t" value="0.5"/><float name="scale" value="3"/>)", "0.3, 0.4, 20", "0.3, 0.4, 0",
     glm::dvec3(1.5)},
    {"ThreeChannels", constant("0.2, 0.5, 0.9", ""), "0.3, 0.4, 20", "0.3, 0.4, 0", {0.2, 0.5, 0.9}},
    {"Stretched", constant("0.5", R"(<scale x="1" y="1" z="3"/>)"), "0.3, 0.4, 20", "0.3, 0.4, 0", glm::dvec3(1.5)},
    {"Mirrored", constant("0.5", R"(<scale x="1" y="1" z="-1"/>)")},
    {"TurnedThroughItsMiddle", constant("0.5", kTurned), "0.1, 0.1, 20", "0.1, 0.1, 0", glm::dvec3(0.5 * kDiagonal)},
    {"TurnedNearItsEdge", constant("0.5", kTurned), "0.65, 0.1, 20", "0.65, 0.1, 0", glm::dvec3(0.5 * kDiagonal),
     "heterogeneous", true},
    {"CameraWithinTheBox", constant("0.5", ""), "0.3, 0.4, 0.5", "0.3, 0.4, 0", glm::dvec3(0.25), "heterogeneous",
     true},
    {"CameraBehindTheBox", constant("0.5", ""), "0.3, 0.4, -1", "0.3, 0.4, -2", glm::dvec3(0)},
    {"LargerThanTheBoundary", constant("0.1", R"(<translate x="-0.5" y="-0.5" z="-0.5"/><scale value="100"/>)"),
     "0.3, 0.4, 20", "0.3, 0.4, 0", glm::dvec3(0.8)},
    {"HomogeneousFillsItsBoundary", constant("0.1", R"(<scale value="0.1"/>)"), "0.3, 0.4, 20", "0.3, 0.4, 0",
     glm::dvec3(0.8), "homogeneous"},
};

std::string sceneText(const ExtentCase& c) {
    std::string text = sceneXml(fmt::format(R"(<emitter type="constant"/>
<shape type="cube"><transform name="to_world"><scale value="4"/></transform><bsdf type="null"/>
<medium type="{}" name="interior">{}<volume name="albedo" type="constvolume"><rgb name="value" value="0"/>
<transform name="to_world"><translate x="10"/></transform></volume></medium></shape>)",
                                            c.type, c.sigmaT),
                                {.origin = c.origin});
    const auto replace = [&text](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace(R"(name="fov" value="40")", R"(name="fov" value="0.01")");
    replace(R"(target="0, 0, 0")", fmt::format(R"(target="{}")", c.target));
    return text;
}

class ConstantExtent : public testing::TestWithParam<ExtentCase> {};

TEST_P(ConstantExtent, TransmitsWhatItsBoxLeaves) {
    const CompiledScene scene = compileText(sceneText(GetParam()), {32, 32});
    for (const Backend backend : kBackends) {
        if (backend == Backend::Vulkan && !GetParam().onDevice) continue;
        const Film film = renderOn(backend, scene, 64);
        EXPECT_EQ(countAnomalies(film), 0u);
        for (int channel = 0; channel < 3; ++channel) {
            const PixelEstimate mean = imageMean(film, channel);
            const double exact = std::exp(-GetParam().opticalDepth[channel]);
            // Rounding: some 100 float operations, and for grids the bound's margin of 2^-20, which changes no mean.
            EXPECT_NEAR(mean.mean, exact, kZ * mean.error + 1e-5) << name(backend) << ", channel " << channel;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, ConstantExtent, testing::ValuesIn(kCases),
                         [](const auto& info) { return info.param.name; });

CompiledScene fogIn(const std::string& shape, const std::string& type) {
    return compileText(sceneXml(fmt::format(R"(<emitter type="constant"/>
<medium id="fog" type="{}"><float name="sigma_t" value="2"/></medium>{})",
                                            type, shape)),
                       {8, 8});
}

// What its box does not cut stays homogeneous: the same arrays, the same film, no note. Faces in common do not cut.
TEST(ConstantExtentCompilation, LeavesAloneWhatLiesWithinTheBox) {
    const std::string cube =
        R"(<shape type="cube"><transform name="to_world"><scale value="0.5"/><translate value="0.5"/>
</transform><bsdf type="null"/><ref name="interior" id="fog"/></shape>)";
    const std::string ball = R"(<shape type="sphere"><point name="center" x="0.5" y="0.5" z="0.5"/>
<float name="radius" value="{}"/><bsdf type="null"/><ref name="interior" id="fog"/></shape>)";
    const auto sphere = [&](double radius) { return fmt::format(fmt::runtime(ball), radius); };
    const std::string beside = R"(<shape type="cube"><transform name="to_world"><translate x="9"/></transform>
<bsdf type="null"/><ref name="interior" id="fog"/></shape>)";
    for (const std::string& shape : {cube, sphere(0.5)}) {
        const CompiledScene inside = fogIn(shape, "heterogeneous");
        EXPECT_EQ(inside.constants.media[0].flags & shared::kMediumHomogeneous, shared::kMediumHomogeneous);
        EXPECT_TRUE(inside.density.empty());
        EXPECT_EQ(inside.notes, fogIn(shape, "homogeneous").notes);
    }
    for (const std::string& shapes : {sphere(0.51), cube + beside}) {
        const CompiledScene cut = fogIn(shapes, "heterogeneous");
        EXPECT_EQ(cut.constants.media[0].flags & shared::kMediumHomogeneous, 0u);
        EXPECT_EQ(cut.density, std::vector<float>{1.0f});
        EXPECT_EQ(cut.notes.size(), fogIn(shapes, "homogeneous").notes.size() + 1);
    }
}

// Mitsuba goes on with the values at the sides of a turned grid; here the grid ends, and a note says so where it shows.
TEST(TurnedGrid, IsNotedWhereMitsubaGoesOnWithIt) {
    const TemporaryFolder folder;
    const auto notes = [&](float side, const std::string& turn, const std::string& boundary) {
        std::vector<float> values(27, side);
        values[13] = 1.0f;  // the middle one
        Volume volume;
        volume.density = DensityGrid::fromDense(glm::uvec3(3), values);
        writeVolume(folder.path() / "grid.vol", volume);
        return compileText(sceneXml(fmt::format(R"(<emitter type="constant"/>
<shape type="cube"><transform name="to_world"><translate value="1"/><scale value="0.5"/>{}</transform><bsdf type="null"/>
<medium type="heterogeneous" name="interior"><volume name="sigma_t" type="gridvolume">
<string name="filename" value="{}"/><transform name="to_world">{}</transform></volume></medium></shape>)",
                                                boundary, (folder.path() / "grid.vol").string(), turn)),
                           {8, 8})
            .notes.size();
    };
    const std::string turn = R"(<rotate y="1" angle="30"/>)", quarter = R"(<rotate y="1" angle="90"/>)";
    const std::string larger = R"(<translate value="-0.5"/><scale value="3"/><translate value="0.5"/>)";
    EXPECT_EQ(notes(1.0f, turn, larger), 1u);
    EXPECT_EQ(notes(0.0f, turn, larger), 0u) << "nothing at its sides";
    EXPECT_EQ(notes(1.0f, turn, turn), 0u) << "its own box";
    EXPECT_EQ(notes(1.0f, quarter, larger), 0u) << "aligned with the axes";
}

}  // namespace
}  // namespace parhelion
