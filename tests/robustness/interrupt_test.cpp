// SIGINT and SIGTERM while a render runs.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "image/image.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"

namespace parhelion::test {
namespace {

/// Far more samples than a test has time for.
constexpr const char* kEndless = "1000000000";

/// The first pass over the image has begun by then.
constexpr auto kWellIntoTheRender = std::chrono::milliseconds(500);

/// Fog without absorption, so deep that a path scatters hundreds of times: a pass over a large image takes many
/// seconds.
SceneText slowScene() {
    SceneText scene;
    scene.integrator = R"(<integrator type="volpath"><integer name="max_depth" value="-1"/></integrator>)";
    scene.medium = R"(<medium id="fog" type="homogeneous">
    <float name="sigma_t" value="300"/>
    <float name="albedo" value="1"/>
</medium>)";
    return scene;
}

void expectReadable(const TemporaryFolder& folder) {
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out.exr", "out.png", "scene.xml"}));
    const Image image = readExr(folder.path() / "out.exr");
    EXPECT_EQ(image.size, glm::uvec2(16, 12));
    const auto& red = image.channels.at("R");
    EXPECT_TRUE(std::all_of(red.begin(), red.end(), [](float value) { return std::isfinite(value) && value >= 0; }));
    EXPECT_FLOAT_EQ(red.front(), 1.0f) << "the upper left pixel sees nothing but the sky";
    const auto samples = std::get<std::int64_t>(image.attributes.at("samplesPerPixel"));
    EXPECT_GT(samples, 0);
    EXPECT_LT(samples, 1000000000);
}

class Interrupt : public testing::TestWithParam<std::string> {};

TEST_P(Interrupt, WritesTheImageSoFar) {
    for (const int signal : {SIGINT, SIGTERM}) {
        SCOPED_TRACE(signal);
        const TemporaryFolder folder;
        folder.write("scene.xml", SceneText{}.text());
        ChildProgram program(test::programFile(),
                             {"render", "scene.xml", "--spp", kEndless, "-o", "out.exr", "--backend", GetParam()},
                             folder.path());
        ASSERT_TRUE(program.waitForError("rendering")) << program.wait().error;
        std::this_thread::sleep_for(kWellIntoTheRender);
        program.signal(signal);
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exitCode, 130) << result.error;
        EXPECT_NE(result.output.find("interrupted after "), std::string::npos) << result.output;
        expectReadable(folder);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Interrupt, testing::Values("vulkan", "reference"),
                         [](const auto& info) { return info.param; });

// A pass of minutes: the promise is two seconds and a dispatch, features included; the rest is for a loaded machine,
// and for a start that compiles. Finishing the samples begun took sixteen passes.
TEST(FirstInterrupt, EndsWithinSecondsHoweverLongAPassIs) {
    for (const std::string backend : {"vulkan", "reference"}) {
        const TemporaryFolder folder;
        folder.write("scene.xml", slowScene().text());
        ChildProgram program(programFile(),
                             {"render", "scene.xml", "--size", "512x512", "--spp", kEndless, "-o", "out.exr",
                              "--backend", backend, "--feature-spp", "1"},
                             folder.path());
        ASSERT_TRUE(program.waitForError("rendering"));
        std::this_thread::sleep_for(kWellIntoTheRender);
        const auto start = std::chrono::steady_clock::now();
        program.signal(SIGINT);
        const ProgramResult result = program.wait();
        const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
        EXPECT_EQ(result.exitCode, 130) << result.error;
        EXPECT_LT(waited.count(), 20) << backend;
        if (folder.names().contains("out.exr"))
            EXPECT_GT(std::get<std::int64_t>(readExr(folder.path() / "out.exr").attributes.at("samplesPerPixel")), 0);
        else
            EXPECT_NE(result.error.find("nothing was written"), std::string::npos) << result.error;
    }
}

TEST(SecondInterrupt, EndsAtOnceAndWritesNothing) {
    const TemporaryFolder folder;
    folder.write("scene.xml", slowScene().text());
    ChildProgram program(
        test::programFile(),
        {"render", "scene.xml", "--size", "1024x1024", "-o", "out.exr", "--backend", "reference", "--feature-spp", "0"},
        folder.path());
    ASSERT_TRUE(program.waitForError("rendering"));
    std::this_thread::sleep_for(kWellIntoTheRender);
    program.signal(SIGINT);
    ASSERT_TRUE(program.waitForError("interrupt again to abort"));
    program.signal(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exitCode, 130) << result.error;
    // Had the render gone on, the image would be there.
    EXPECT_EQ(folder.names(), std::set<std::string>{"scene.xml"});
}

}  // namespace
}  // namespace parhelion::test
