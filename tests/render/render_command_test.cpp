// parhelion render and its neighbours, end to end.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "image/image.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

using nlohmann::json;

class RenderCommand : public testing::Test {
protected:
    RenderCommand() { folder_.write("scene.xml", SceneText{}.text()); }

    /// Runs the program, which must succeed.
    ProgramResult run(const std::vector<std::string>& arguments) {
        const ProgramResult result = runProgram(test::programFile(), arguments, folder_.path());
        EXPECT_EQ(result.exitCode, 0) << result.error;
        return result;
    }

    Image render(const std::string& output, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"render", "scene.xml", "-o", output});
        run(more);
        return readExr(folder_.path() / output);
    }

    TemporaryFolder folder_;
};

/// The values of the radiance channels must be the same to the bit.
void expectSameRadiance(const Image& a, const Image& b) {
    ASSERT_EQ(a.size, b.size);
    for (const char* channel : {"R", "G", "B", "variance.R"}) EXPECT_EQ(a.channels.at(channel), b.channels.at(channel));
}

TEST_F(RenderCommand, NamesItsOutputsAfterTheScene) {
    run({"render", "scene.xml"});
    EXPECT_EQ(folder_.names(), (std::set<std::string>{"scene.exr", "scene.png", "scene.xml"}));
}

TEST_F(RenderCommand, DescribesItselfInTheImage) {
    const Image image = render("out.exr", {"--seed", "7", "--spp", "5"});
    const auto text = [&](const char* name) { return std::get<std::string>(image.attributes.at(name)); };
    const auto number = [&](const char* name) { return std::get<std::int64_t>(image.attributes.at(name)); };
    EXPECT_EQ(image.size, glm::uvec2(16, 12));
    EXPECT_EQ(text("parhelion.scene"), "scene.xml");
    EXPECT_EQ(text("parhelion.backend"), "vulkan");
    EXPECT_NE(text("parhelion.device"), "");
    EXPECT_NE(text("parhelion.effects").find("hasHomogeneousMedia"), std::string::npos);
    EXPECT_NE(text("parhelion.quality").find("shadowRoulette=3"), std::string::npos);
    EXPECT_EQ(number("parhelion.seed"), 7);
    EXPECT_EQ(number("samplesPerPixel"), 5);
    EXPECT_EQ(number("parhelion.nonFinite"), 0);
    EXPECT_GT(std::get<double>(image.attributes.at("renderTimeSeconds")), 0);
}

TEST_F(RenderCommand, RepeatsItselfToTheBitAndChangesWithTheSeed) {
    const Image first = render("a.exr"), second = render("b.exr"), other = render("c.exr", {"--seed", "1"});
    expectSameRadiance(first, second);
    EXPECT_NE(first.channels.at("R"), other.channels.at("R"));
}

TEST_F(RenderCommand, GivesTheSameImageWithEveryEffectCompiledIn) {
    expectSameRadiance(render("a.exr"), render("b.exr", {"--effects", "all"}));
}

TEST_F(RenderCommand, CropsAreTheSamePixels) {
    const Image whole = render("whole.exr"), crop = render("crop.exr", {"--crop", "5,3,7x6"});
    ASSERT_EQ(crop.size, glm::uvec2(7, 6));
    for (unsigned y = 0; y < 6; ++y)
        for (unsigned x = 0; x < 7; ++x)
            EXPECT_EQ(crop.channels.at("R")[y * 7 + x], whole.channels.at("R")[(y + 3) * 16 + x + 5]) << x << ", " << y;
}

TEST_F(RenderCommand, TakesTheBackendsForOneAnother) {
    // The same draws and decisions: samples differ by rounding only, except the rare ones where rounding turned a
    // decision. 4 samples of at most 1 a pixel: a turned path moves its pixel by 0.25 at most. Allowed: 2 of 192
    // pixels. A different random stream or scene would move nearly all of the pixels on the fog.
    const Image device = render("a.exr");
    for (const std::string backend : {"reference", "reference-double"}) {
        const Image reference = render("b.exr", {"--backend", backend});
        int different = 0;
        for (std::size_t i = 0; i < device.channels.at("R").size(); ++i)
            different += std::abs(device.channels.at("R")[i] - reference.channels.at("R")[i]) > 1e-4f;
        EXPECT_LE(different, 2) << backend;
    }
}

TEST_F(RenderCommand, ReportsAsJson) {
    const ProgramResult result = run({"render", "scene.xml", "--json", "--size", "8x4", "--backend", "reference"});
    const json report = json::parse(result.output);
    EXPECT_EQ(report["filmSize"], json({8, 4}));
    EXPECT_EQ(report["samples"], 4);
    EXPECT_EQ(report["exr"], "scene.exr");
    EXPECT_EQ(report["interrupted"], false);
    EXPECT_EQ(report["anomalies"], false);
    EXPECT_EQ(report["counters"]["pathsFinished"], 8 * 4 * 4);
    EXPECT_GT(report["relativeError"], 0.0);
}

double attribute(const Image& image, const std::string& name) { return std::get<double>(image.attributes.at(name)); }

TEST_F(RenderCommand, KnowsItsError) {
    for (const std::string backend : {"vulkan", "reference"}) {
        const Image image = render("out.exr", {"--spp", "64", "--backend", backend, "--report", "error.json"});
        const json report = json::parse(readTextFile(folder_.path() / "error.json"));
        const json& estimate = report["error"]["estimate"];
        EXPECT_EQ(attribute(image, "parhelion.error"), estimate["rms"]["value"].get<double>());
        EXPECT_GT(estimate["rms"]["upper"], estimate["rms"]["value"]);
        EXPECT_LT(estimate["rms"]["lower"], estimate["rms"]["value"]);
        for (const std::string channel : {"R", "G", "B", "Y"}) {
            EXPECT_LE(estimate["mean"][channel]["lower"], estimate["mean"][channel]["value"]);
            EXPECT_GE(estimate["mean"][channel]["upper"], estimate["mean"][channel]["value"]);
        }
        EXPECT_GE(report["error"]["checks"].size(), 10u);
        // The layers: an interval around every pixel, which is 1 or 0 trusted.
        const auto &halfWidth = image.channels.at("error.Y"), &trust = image.channels.at("trust.Y");
        double trusted = 0;
        for (std::size_t i = 0; i < trust.size(); ++i) {
            EXPECT_TRUE(trust[i] == 0 || trust[i] == 1);
            EXPECT_TRUE(std::isfinite(halfWidth[i]) && halfWidth[i] >= 0);
            trusted += trust[i] / double(trust.size());
        }
        EXPECT_NEAR(trusted, estimate["pixels"]["trusted"].get<double>(), 1e-6);
    }
}

TEST_F(RenderCommand, RendersToAnError) {
    render("out.exr", {"--error", "4%", "--report", "error.json"});
    const json report = json::parse(readTextFile(folder_.path() / "error.json"));
    EXPECT_EQ(report["endedBy"], "error");
    EXPECT_LE(report["error"]["controlError"], 0.04);
    EXPECT_NEAR(report["error"]["estimate"]["rms"]["value"].get<double>(), 0.04, 0.015);
    EXPECT_GE(report["error"]["checkpoints"].size(), 2u);
    const Image same = readExr(folder_.path() / "out.exr");
    // The image is that of so many samples asked for.
    const std::string samples = std::to_string(report["samples"].get<int>());
    EXPECT_EQ(render("same.exr", {"--spp", samples}).channels.at("R"), same.channels.at("R"));
}

TEST_F(RenderCommand, EndsAtTheMaximumOrInTime) {
    render("out.exr", {"--error", "0.01%", "--spp", "50", "--report", "error.json"});
    json report = json::parse(readTextFile(folder_.path() / "error.json"));
    EXPECT_EQ(report["endedBy"], "samples");
    EXPECT_EQ(report["samples"], 50);
    EXPECT_GT(report["error"]["samplesForTarget"], 50.0);
    render("out.exr", {"--error", "0.001%", "--time", "4s", "--report", "error.json"});
    report = json::parse(readTextFile(folder_.path() / "error.json"));
    EXPECT_EQ(report["endedBy"], "time");
    EXPECT_GT(report["samples"], 16);
}

TEST_F(RenderCommand, WritesAPageAboutTheError) {
    render("out.exr", {"--spp", "64", "--report", "error.html"});
    const std::string page = readTextFile(folder_.path() / "error.html");
    EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
    EXPECT_NE(page.find("Can it be trusted?"), std::string::npos);
    for (const std::string outside : {"http:", "https:", "<script"}) EXPECT_EQ(page.find(outside), std::string::npos);
}

TEST_F(RenderCommand, PrintsErrorsOnlyWhenQuiet) {
    const ProgramResult result = run({"render", "scene.xml", "--quiet"});
    EXPECT_EQ(result.output + result.error, "");
}

TEST_F(RenderCommand, DefinesReplaceDefaults) {
    SceneText scene;
    scene.start = "<default name=\"width\" value=\"16\"/>";
    scene.width = "<integer name=\"width\" value=\"$width\"/>";
    folder_.write("scene.xml", scene.text());
    EXPECT_EQ(render("a.exr").size, glm::uvec2(16, 12));
    EXPECT_EQ(render("b.exr", {"-D", "width=9"}).size, glm::uvec2(9, 12));
}

TEST_F(RenderCommand, InspectTellsEveryEffectWithItsReason) {
    const json scene = json::parse(run({"inspect", "scene.xml", "--json"}).output);
    bool media = false;
    for (const json& effect : scene["effects"]) {
        EXPECT_NE(effect["reason"], "") << effect["name"];
        if (effect["name"] == "hasHomogeneousMedia") media = effect["simulated"];
        if (effect["name"] == "hasTriangles") {
            EXPECT_EQ(effect["simulated"], false);
        }
    }
    EXPECT_TRUE(media);
    EXPECT_EQ(scene["boxes"], 1);
    EXPECT_EQ(scene["media"].size(), 1u);
    EXPECT_NE(run({"inspect", "scene.xml"}).output.find("homogeneous"), std::string::npos);
}

TEST_F(RenderCommand, CompareJudgesByTheLimitsGiven) {
    render("a.exr");
    render("b.exr", {"--max-depth", "0"});
    run({"compare", "a.exr", "a.exr", "--max-mse", "0", "--agree"});
    const ProgramResult free = run({"compare", "a.exr", "b.exr", "--json", "--error", "difference.exr"});
    const double mse = json::parse(free.output)["mse"];
    EXPECT_GT(mse, 0);
    EXPECT_TRUE(readExr(folder_.path() / "difference.exr").has("error.R"));
    EXPECT_TRUE(folder_.names().contains("difference.png"));
    run({"compare", "a.exr", "b.exr", "--pictures", "pair"});
    for (const char* name : {"pair_a.png", "pair_b.png", "pair_error.png", "pair_z.png"})
        EXPECT_TRUE(folder_.names().contains(name)) << name;
    const auto exitCode = [&](double limit) {
        return runProgram(test::programFile(), {"compare", "a.exr", "b.exr", "--max-mse", std::to_string(limit)},
                          folder_.path())
            .exitCode;
    };
    EXPECT_EQ(exitCode(2 * mse), 0);
    EXPECT_EQ(exitCode(0.5 * mse), 1);
}

TEST_F(RenderCommand, CompareTellsNoiseFromBias) {
    for (const std::string seed : {"1", "2"}) render(seed + ".exr", {"--seed", seed, "--sampler", "independent"});
    const ProgramResult same =
        run({"compare", "1.exr", "2.exr", "--noise-alone", "--mean-within", "0.5", "--error-range", "0.1", "--json"});
    EXPECT_EQ(json::parse(same.output)["budget"]["level"], "independent");
    render("black.exr", {"--max-depth", "0"});
    for (const std::vector<std::string>& limit :
         {std::vector<std::string>{"--noise-alone"}, {"--mean-within", "0.5"}}) {
        std::vector<std::string> arguments{"compare", "1.exr", "black.exr"};
        arguments.insert(arguments.end(), limit.begin(), limit.end());
        EXPECT_EQ(runProgram(test::programFile(), arguments, folder_.path()).exitCode, 1) << limit.front();
    }
}

/// The back ends draw the same random numbers: their films differ by far less than their noise.
TEST_F(RenderCommand, CompareKnowsIdenticalAndPairedImages) {
    render("a.exr", {"--sampler", "independent"});
    render("twin.exr", {"--sampler", "independent", "--backend", "reference-double"});
    const auto exitCode = [&](const std::string& other, const std::string& limit) {
        return runProgram(test::programFile(), {"compare", "a.exr", other, limit}, folder_.path()).exitCode;
    };
    EXPECT_EQ(run({"compare", "a.exr", "a.exr"}).output.rfind("identical: ", 0), 0u);
    EXPECT_EQ(run({"compare", "a.exr", "a.exr"}).output.find("NOISE"), std::string::npos);
    EXPECT_EQ(json::parse(run({"compare", "a.exr", "a.exr", "--json"}).output)["verdict"], "identical");
    const json paired = json::parse(run({"compare", "a.exr", "twin.exr", "--json", "--noise-alone"}).output);
    EXPECT_EQ(paired["verdict"], "lessNoise");
    EXPECT_EQ(paired["requirements"][0]["id"], "noiseAlone");
    for (const std::string other : {"a.exr", "twin.exr"}) {
        EXPECT_EQ(exitCode(other, "--noise-alone"), 0) << other;
        EXPECT_EQ(exitCode(other, "--agree"), 0) << other;
        EXPECT_EQ(exitCode(other, "--independent-noise"), 1) << other;
    }
}

TEST_F(RenderCommand, ConvertKeepsEveryVoxelThroughEveryFormat) {
    Volume volume;
    volume.density = DensityGrid({11, 9, 20});
    for (unsigned i = 0; i < 9; ++i) volume.density.set({i, i, 2 * i}, 0.1f * static_cast<float>(i + 1));
    writeVolume(folder_.path() / "0.vol", volume);
    run({"convert", "0.vol", "1.grid"});
    run({"convert", "1.grid", "2.vdb"});
    run({"convert", "2.vdb", "3.nvdb"});
    run({"convert", "3.nvdb", "4.vol"});
    const Volume back = readVolume(folder_.path() / "4.vol", {});
    EXPECT_EQ(back.density.resolution(), volume.density.resolution());
    EXPECT_EQ(back.density.toDense(), volume.density.toDense());
}

TEST_F(RenderCommand, DevicesListsWhatRenders) {
    const json devices = json::parse(run({"devices", "--json"}).output);
    ASSERT_FALSE(devices.empty());
    EXPECT_NE(devices[0]["name"], "");
    run({"render", "scene.xml", "--device", "0"});
}

}  // namespace
}  // namespace parhelion::test
