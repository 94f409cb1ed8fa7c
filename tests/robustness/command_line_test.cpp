// The command line: usage errors, places that cannot be written, help.
#include <gtest/gtest.h>

#include <ostream>

#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"

namespace parhelion::test {
namespace {

using Arguments = std::vector<std::string>;

struct BadUsage {
    std::string name;
    Arguments arguments;
    std::string message;  ///< what the error must say

    friend void PrintTo(const BadUsage& bad, std::ostream* stream) { *stream << bad.name; }
};

/// A render of the good scene with these arguments more.
BadUsage badRender(std::string name, const Arguments& more, std::string message) {
    Arguments arguments{"render", "scene.xml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {std::move(name), arguments, std::move(message)};
}

std::vector<BadUsage> badValues() {
    const std::string kSize = "--size: expected WIDTHxHEIGHT, each 1..65536; got ";
    return {
        badRender("ZeroSize", {"--size", "0x5"}, kSize + "0x5"),
        badRender("NegativeSize", {"--size", "-4x5"}, kSize + "-4x5"),
        badRender("HugeSize", {"--size", "65537x1"}, kSize + "65537x1"),
        badRender("OneNumberSize", {"--size", "64"}, kSize + "64"),
        badRender("SizeWithTail", {"--size", "64x64x64"}, kSize + "64x64x64"),
        badRender("ZeroSamples", {"--spp", "0"}, "--spp: expected a whole number from 1 to 1099511627776; got 0"),
        badRender("SamplesNoNumber", {"--spp", "many"}, "--spp: expected a whole number"),
        badRender("SamplesOverflow", {"--spp", "99999999999999999999"}, "got 99999999999999999999"),
        badRender("FractionalSeed", {"--seed", "1.5"}, "--seed: expected a whole number from 0 to 4294967295; got 1.5"),
        badRender("NegativeDepth", {"--max-depth", "-2"}, "--max-depth: expected a whole number from -1"),
        badRender("TooManyDepthLayers", {"--depth-layers", "65"},
                  "--depth-layers: expected a whole number from 0 to 64"),
        badRender("NanExposure", {"--exposure", "nan"}, "--exposure: expected a number from -64 to 64; got nan"),
        badRender("InfiniteRoulette", {"--shadow-roulette", "inf"}, "--shadow-roulette: expected a number"),
        badRender("UnknownBackend", {"--backend", "cuda"},
                  "--backend: expected reference|reference-double|vulkan; got cuda"),
        badRender("UnknownFilter", {"--density-filter", "cubic"}, "got cubic"),
        badRender("UnknownDevice", {"--device", "no such device"}, "no such device"),
        badRender("OddVectorBits", {"--vector-bits", "300"}, "got 300"),
        badRender("DefineWithoutValue", {"-D", "spp"}, "-D: expected name=value; got spp"),
        badRender("CropWithoutSize", {"--crop", "1,2"}, "--crop: expected X,Y,WIDTHxHEIGHT"),
        badRender("EmptyCrop", {"--crop", "1,2,0x4"}, "--crop: expected X,Y,WIDTHxHEIGHT"),
        badRender("CropOutside", {"--crop", "10,0,8x8"}, "--crop: must lie inside the film of 16x12; got 10,0,8x8"),
        badRender("DeviceForReference", {"--backend", "reference", "--device", "0"},
                  "--device: only --backend vulkan has it; got --backend reference\n"),
        badRender("DeviceForDoubleReference", {"--backend", "reference-double", "--device", "0"},
                  "--device: only --backend vulkan has it; got --backend reference-double\n"),
        badRender("LanesForDoubleReference", {"--vector-bits", "256", "--backend", "reference-double"},
                  "--vector-bits: only --backend vulkan has it; got --backend reference-double\n"),
    };
}

std::vector<BadUsage> badTargets() {
    return {
        badRender("ErrorOfNothing", {"--error", "0%"},
                  "--error: expected a share as 1%, 0.5% or 0.01, from 0.0002% to 100%; got 0%\n"),
        badRender("ErrorOfTwice", {"--error", "2"}, "--error: expected a share as 1%"),
        badRender("ErrorNoNumber", {"--error", "%"}, "--error: expected a share as 1%"),
        badRender("ErrorNotFinite", {"--error", "nan%"}, "--error: expected a share as 1%"),
        badRender("ErrorNormUnknown", {"--error-norm", "max"},
                  "--error-norm: expected mean|pixels|relmse|rms; got max\n"),
        badRender("TimeOfNothing", {"--time", "0s"},
                  "--time: expected a time as 30s, 5m or 2h, from 0.01s to 1e7s; got 0s\n"),
        badRender("TimeWithoutNumber", {"--time", "m"}, "--time: expected a time as 30s"),
        badRender("TimeInDays", {"--time", "1d"}, "--time: expected a time as 30s"),
        badRender("ErrorForReference", {"--error", "1%", "--backend", "reference"},
                  "--error: only --backend vulkan has it; got --backend reference\n"),
        badRender("TimeForReference", {"--time", "5s", "--backend", "reference"},
                  "--time: only --backend vulkan has it; got --backend reference\n"),
    };
}

std::vector<BadUsage> badUses() {
    return {
        {"NoCommand", {}, "subcommand"},
        {"UnknownCommand", {"rendre", "scene.xml"}, "expected a command: render, inspect, compare"},
        {"NoScene", {"render"}, "SCENE"},
        badRender("UnknownOption", {"--sp", "4"}, "--sp"),
        badRender("MissingValue", {"--spp"}, "--spp"),
        badRender("RepeatedOption", {"--spp", "4", "--spp", "8"}, "--spp"),
        // 4 Gi pixels: about a terabyte.
        badRender("FilmBeyondMemory", {"--size", "65536x65536"}, "film of 65536x65536 needs "),
        // 64 Mi pixels in 64 layers of 60 bytes: about 240 GiB.
        badRender("LayersBeyondMemory", {"--size", "8192x8192", "--depth-layers", "64"},
                  "film of 8192x8192 with 64 depth layers needs "),
        badRender("NoExr", {"-o", "image.jpg"}, ".exr"),
        badRender("ReportOfUnknownKind", {"--report", "report.txt"},
                  "--report: expected a name that ends in .html or .json"),
        badRender("ReportInMissingFolder", {"--report", "missing/report.html"}, "missing/report.html"),
        badRender("OutputInMissingFolder", {"-o", "missing/image.exr"}, "missing/image.exr"),
        badRender("OutputIsFolder", {"-o", "folder.exr"}, "folder.exr"),
        badRender("OutputBelowFile", {"-o", "scene.xml/image.exr"}, "scene.xml/image.exr"),
        badRender("OutputIsDevice", {"-o", "device.exr"}, "device.exr"),
        badRender("OutputIsTheScene", {"-o", "link.exr"}, "--output: link.exr would replace scene.xml"),
        badRender("PngIsTheScene", {"-o", "view.exr"}, "--output: view.png would replace scene.xml"),
        {"ErrorReplacesImage", {"compare", "a.exr", "b.exr", "--error", "b.exr"}, "--error: b.exr would replace b.exr"},
        {"PictureReplacesImage",
         {"compare", "a.exr", "b_z.png", "--pictures", "./b"},
         "--pictures: ./b_z.png would replace b_z.png"},
        {"ConvertOntoItself", {"convert", "a.vol", "./a.vol"}, "OUT: ./a.vol would replace a.vol"},
        {"CompareMissing", {"compare", "a.exr", "b.exr"}, "a.exr"},
        {"CompareNoImage", {"compare", "scene.xml", "scene.xml"}, "scene.xml"},
        {"ConvertMissing", {"convert", "a.vol", "b.vol"}, "a.vol"},
        {"ConvertNoVolume", {"convert", "scene.xml", "b.vol"}, "scene.xml"},
        {"ConvertToNowhere", {"convert", "scene.xml", "missing/b.vol"}, "missing/b.vol"},
    };
}

class CommandLine : public testing::TestWithParam<BadUsage> {};

TEST_P(CommandLine, RefusesBadUsage) {
    const TemporaryFolder folder;
    folder.write("scene.xml", SceneText{}.text());
    std::filesystem::create_directory(folder.path() / "folder.exr");
    std::filesystem::create_symlink("/dev/null", folder.path() / "device.exr");
    for (const char* link : {"link.exr", "view.png"})
        std::filesystem::create_symlink("scene.xml", folder.path() / link);
    const std::set<std::string> before = folder.names();
    const ProgramResult result = runProgram(test::programFile(), GetParam().arguments, folder.path());
    EXPECT_EQ(result.exitCode, 2) << result.error;
    EXPECT_EQ(result.error.rfind("parhelion: error: ", 0), 0u) << result.error;
    EXPECT_NE(result.error.find(GetParam().message), std::string::npos) << result.error;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(folder.names(), before);
}

const auto kUsageName = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Values, CommandLine, testing::ValuesIn(badValues()), kUsageName);
INSTANTIATE_TEST_SUITE_P(Targets, CommandLine, testing::ValuesIn(badTargets()), kUsageName);
INSTANTIATE_TEST_SUITE_P(Uses, CommandLine, testing::ValuesIn(badUses()), kUsageName);

TEST(CommandLineHelp, ShowsExamplesForEveryCommand) {
    const TemporaryFolder folder;
    for (const std::string command : {"", "render", "inspect", "compare", "convert", "devices"}) {
        Arguments arguments{"--help"};
        if (!command.empty()) arguments.insert(arguments.begin(), command);
        const ProgramResult result = runProgram(test::programFile(), arguments, folder.path());
        EXPECT_EQ(result.exitCode, 0) << command << result.error;
        EXPECT_NE(result.output.find("Examples:\n  parhelion " + command), std::string::npos) << result.output;
        EXPECT_EQ(result.error, "");
    }
}

TEST(CommandLineVersion, IsOneLine) {
    const TemporaryFolder folder;
    const ProgramResult result = runProgram(test::programFile(), {"--version"}, folder.path());
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.output.rfind("parhelion ", 0), 0u) << result.output;
    EXPECT_EQ(result.output.find('\n'), result.output.size() - 1) << result.output;
}

TEST(CommandLineOutput, IsCheckedBeforeTheSceneIsRendered) {
    // A render of days: the check must come first.
    const TemporaryFolder folder;
    folder.write("scene.xml", SceneText{}.text());
    ChildProgram program(
        test::programFile(),
        {"render", "scene.xml", "--backend", "reference", "--spp", "1000000000000", "-o", "no/out.exr"}, folder.path());
    EXPECT_EQ(program.wait(std::chrono::seconds(20)).exitCode, 2);
}

}  // namespace
}  // namespace parhelion::test
