#include "mitsuba_reference.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/agreement.h"
#include "scene/scene_description.h"

namespace parhelion::test {

void expectAgreement(const MitsubaReference& reference, const std::string& projectFolder, Backend backend) {
    constexpr std::size_t kSeeds = 8;
    const std::filesystem::path folder = projectFolder;
    const Image image = readExr(folder / "tests" / "references" / (reference.name + ".exr"));
    const auto seeds = static_cast<std::size_t>(std::get<std::int64_t>(image.attributes.at("seeds")));
    CompileOptions compileOptions;
    compileOptions.size = image.size;
    const CompiledScene scene = compileScene(readScene(folder / reference.scene), compileOptions);

    AgreementOptions options;
    options.independentPixels = true;  // box filters
    const ImageAgreement agreement = testAgreement(
        renderSeeds(backend, scene, reference.samples, kSeeds, 1, reference.sobol), image, seeds, options);
    fmt::print("{} on {}: {}", reference.name, name(backend), describe(agreement));
    EXPECT_TRUE(agreement.agree());
    for (const ChannelAgreement& channel : agreement.channels) {
        EXPECT_GT(channel.ratio->lower, 1 - reference.meanTolerance) << channel.channel;
        EXPECT_LT(channel.ratio->upper, 1 + reference.meanTolerance) << channel.channel;
    }
}

}  // namespace parhelion::test
