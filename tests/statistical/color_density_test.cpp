#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "support/exact_optical_depth.h"
#include "support/render_scene.h"
#include "support/rendering.h"
#include "support/temporary_folder.h"
#include "volume/volume_file.h"

// Extinction grids with a value a channel: 9 x 7 x 11 voxels over a turned box, optical depths of order 1, holes in
// single channels.
namespace parhelion {
namespace {

using namespace test;

constexpr glm::uvec3 kResolution{9, 7, 11};
constexpr double kScale = 1.5;
constexpr double kZ = 5.5;  // a family of 1e-6 over 24 comparisons

std::vector<float> colorVoxels(glm::ivec3 order = {0, 1, 2}) {
    std::vector<float> values;
    for (int i = 0; i < 9 * 7 * 11; ++i) {
        const float rgb[] = {float(i * 37 % 101) / 100.0f, i % 3 == 0 ? 0.0f : 0.3f, float(i * 53 % 89) / 300.0f};
        for (int c = 0; c < 3; ++c) values.push_back(rgb[order[c]]);
    }
    return values;
}

/// The box [-1, 1]^3 that holds the grid, in the world.
glm::dmat4 worldFromBox() {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), glm::radians(30.0), glm::dvec3(0, 1, 0));
    return turned * glm::scale(glm::dmat4(1.0), glm::dvec3(1, 0.8, 1.2));
}

const std::string kBox = R"(<scale x="1" y="0.8" z="1.2"/><rotate y="1" angle="30"/>)";

std::string cloudXml(const std::filesystem::path& folder, const std::string& albedo, glm::ivec3 order = {0, 1, 2}) {
    Volume volume;
    volume.channels = 3;
    volume.color = {kResolution, colorVoxels(order)};
    const std::filesystem::path file = folder / fmt::format("cloud{}{}{}.grid", order.x, order.y, order.z);
    writeVolume(file, volume);
    return fmt::format(R"(<medium type="heterogeneous" id="cloud"><float name="scale" value="{}"/>
    <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/><transform name="to_world">
        <translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/>{}</transform></volume>
    <rgb name="albedo" value="{}"/></medium>
    <shape type="cube"><transform name="to_world">{}</transform><bsdf type="null"/><ref name="interior" id="cloud"/>
    </shape>)",
                       kScale, file.string(), kBox, albedo, kBox);
}

/// A narrow view from `origin` towards the world's origin: every pixel has one expectation.
CompiledScene narrowScene(const std::string& body, const std::string& origin) {
    std::string text = sceneXml(body, {.origin = origin});
    const std::string wide = R"(name="fov" value="40")";
    return compileText(text.replace(text.find(wide), wide.size(), R"(name="fov" value="0.001")"), {32, 32});
}

/// Transmittance of one channel from `from` along the unit `direction` to beyond the box.
double transmittance(const glm::dvec3& from, const glm::dvec3& direction, int channel) {
    std::vector<float> values;
    const std::vector<float> voxels = colorVoxels();
    for (std::size_t i = channel; i < voxels.size(); i += 3) values.push_back(voxels[i]);
    const glm::dmat4 boxFromWorld = glm::inverse(worldFromBox());
    const glm::dvec3 half = 0.5 * glm::dvec3(kResolution);
    const glm::dvec3 o = (glm::dvec3(boxFromWorld * glm::dvec4(from, 1)) + 1.0) * half;
    const glm::dvec3 d = glm::dvec3(boxFromWorld * glm::dvec4(direction, 0)) * half;
    double entry = 0, exit = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = -o[axis] / d[axis], b = (double(kResolution[axis]) - o[axis]) / d[axis];
        entry = std::max(entry, std::min(a, b));
        exit = std::min(exit, std::max(a, b));
    }
    return std::exp(-ExactOpticalDepth(values, kResolution, o + entry * d, d, kScale, exit - entry).total());
}

double deviation(const Film& film, int channel, double expected) {
    const PixelEstimate mean = imageMean(film, channel);
    return (mean.mean - expected) / mean.error;
}

class ColorDensity : public testing::TestWithParam<Backend> {
protected:
    TemporaryFolder folder_;
};

// Flights through a cloud that scatters nothing: each channel sees the sky through its own optical depth.
TEST_P(ColorDensity, FlightsSeeEachChannelsTransmittance) {
    const glm::dvec3 from(0.3, 0.6, 5);
    const std::string sky = R"(<emitter type="constant"/>)";
    const CompiledScene scene = narrowScene(sky + cloudXml(folder_.path(), "0"), "0.3, 0.6, 5");
    ASSERT_TRUE(scene.effects.has(Effect::hasColorDensity) && scene.effects.has(Effect::hasChromaticExtinction));
    const Film film = renderOn(GetParam(), scene, 512);
    EXPECT_EQ(countAnomalies(film), 0u);
    for (int c = 0; c < 3; ++c) {
        const double expected = transmittance(from, glm::normalize(-from), c);
        EXPECT_LT(std::abs(deviation(film, c, expected)), kZ) << c << ": " << expected;
        EXPECT_LT(imageMean(film, c).error, 0.004 * expected) << "a bias of 3 % would show";
        // Seeded defect: another channel's density.
        const double other = transmittance(from, glm::normalize(-from), (c + 1) % 3);
        EXPECT_GT(std::abs(deviation(film, c, other)), kZ) << c << ": " << other;
    }
}

// Shadow rays: a floor behind the cloud, lit through it; the camera is between them.
TEST_P(ColorDensity, ShadowRaysSeeEachChannelsTransmittance) {
    const std::string body = R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/>
    <translate z="-3"/></transform><bsdf type="diffuse"/></shape>
    <emitter type="directional"><vector name="direction" x="0.2" y="0.1" z="-1"/></emitter>)";
    std::string text = sceneXml(body + cloudXml(folder_.path(), "0"), {.origin = "0.2, 0.1, -2"});
    const auto replace = [&text](const std::string& old, const std::string& fresh) {
        text.replace(text.find(old), old.size(), fresh);
    };
    replace(R"(name="fov" value="40")", R"(name="fov" value="0.001")");
    replace(R"(target="0, 0, 0")", R"(target="0.2, 0.1, -3")");
    const Film film = renderOn(GetParam(), compileText(text, {32, 32}), 256);
    const glm::dvec3 toSun = glm::normalize(glm::dvec3(-0.2, -0.1, 1));
    for (int c = 0; c < 3; ++c) {
        const double expected = 0.5 / M_PI * toSun.z * transmittance({0.2, 0.1, -3}, toSun, c);
        EXPECT_LT(std::abs(deviation(film, c, expected)), kZ) << c << ": " << expected;
        EXPECT_LT(imageMean(film, c).error, 0.005 * expected) << "a bias of 4 % would show";
    }
}

// What absorbs nothing in a uniform sky looks like the sky, in every channel.
TEST_P(ColorDensity, FurnaceIsWhite) {
    const std::string body = R"(<emitter type="constant"/>)" + cloudXml(folder_.path(), "1");
    const Film film = renderOn(GetParam(), narrowScene(body, "0.3, 0.6, 5"), 256);
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(std::abs(deviation(film, c, 1)), kZ) << c << ": " << imageMean(film, c).mean;
        EXPECT_LT(imageMean(film, c).error, 0.004) << "a bias of 3 % would show";
    }
}

// Channels turned by one in grid and albedo turn the image by one.
TEST_P(ColorDensity, PermutedChannelsPermuteTheImage) {
    const std::string lights = R"(<emitter type="constant"/><emitter type="directional">
    <vector name="direction" x="-0.6" y="-0.7" z="-0.3"/></emitter>)";
    const CompiledScene scene = compileText(sceneXml(lights + cloudXml(folder_.path(), "0.9, 0.8, 0.5")), {32, 32});
    const CompiledScene turned =
        compileText(sceneXml(lights + cloudXml(folder_.path(), "0.8, 0.5, 0.9", {1, 2, 0})), {32, 32});
    const Film a = renderOn(GetParam(), scene, 256, 1), b = renderOn(GetParam(), turned, 256, 2);
    for (int c = 0; c < 3; ++c) {
        // Over the image the samples' expectations differ: the spread counts that as noise, which only widens the test.
        const PixelEstimate left = imageMean(a, (c + 1) % 3), right = imageMean(b, c);
        EXPECT_LT(std::abs(left.mean - right.mean) / std::hypot(left.error, right.error), kZ) << c;
        EXPECT_LT(right.error, 0.003 * right.mean);
    }
}

INSTANTIATE_TEST_SUITE_P(OnTheDevice, ColorDensity, testing::Values(Backend::Vulkan));
INSTANTIATE_TEST_SUITE_P(NightlyOnTheReference, ColorDensity, testing::Values(Backend::Reference));

}  // namespace
}  // namespace parhelion
