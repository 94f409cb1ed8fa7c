#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/agreement.h"
#include "scene/scene_description.h"
#include "support/rendering.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "volume/volume_file.h"

// Clouds of three formats under a uniform sky, and the same clouds converted to two others.
namespace parhelion {
namespace {

using namespace test;

constexpr std::size_t kSeeds = 8;

/// The volume in a box of its own proportions, 1 along its longest side, seen at an angle, under a uniform sky.
std::string sceneText(const std::string& file, glm::dvec3 extent, double extinction) {
    return fmt::format(R"(<scene version="3.0.0"><integrator type="volpath"/>
        <sensor type="perspective"><float name="fov" value="35"/>
        <transform name="to_world"><lookat origin="1.2, 0.7, 1.8" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="32"/>
        <rfilter type="box"/></film></sensor>
        <emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.7"/></emitter>
        <shape type="cube"><bsdf type="null"/>
        <transform name="to_world"><scale x="{1}" y="{2}" z="{3}"/><scale value="0.5"/></transform>
        <medium name="interior" type="heterogeneous"><float name="scale" value="{4}"/>
        <float name="albedo" value="0.95"/><phase type="hg"><float name="g" value="0.5"/></phase>
        <volume name="sigma_t" type="gridvolume"><string name="filename" value="{0}"/>
        <boolean name="use_grid_bbox" value="false"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale x="{1}" y="{2}" z="{3}"/></transform>
        </volume></medium></shape></scene>)",
                       file, extent.x, extent.y, extent.z, extinction);
}

class VolumeFormats : public testing::TestWithParam<const char*> {
protected:
    /// @param seed  of the first image.
    std::vector<Image> see(const std::filesystem::path& volumeFile, std::uint32_t seed) {
        const std::string text = sceneText(volumeFile.string(), extent_, extinction_);
        const CompiledScene scene = compileScene(readScene(folder_.write("scene.xml", text)));
        return renderSeeds(Backend::Vulkan, scene, 16, kSeeds, seed);
    }

    void measure(const Volume& volume) {
        const glm::dvec3 resolution(volume.density.resolution());
        extent_ = resolution / std::max({resolution.x, resolution.y, resolution.z});
        extinction_ = 20 / volume.density.maximum();  // optical thickness of the box, were it full
    }

    TemporaryFolder folder_;
    glm::dvec3 extent_{1};
    double extinction_ = 1;
};

// A conversion that permutes, mirrors or shifts (by a voxel) the grid fails the tiles; one that scales it, the mean.
TEST_P(VolumeFormats, ConvertedVolumesRenderTheSameImage) {
    const auto source = sharedFile(std::string("data/volumes/") + GetParam());
    if (source.empty()) GTEST_SKIP() << "../shared/data/volumes is missing";
    const Volume volume = readVolume(source, {});
    measure(volume);
    const std::vector<Image> original = see(source, 1);
    AgreementOptions options;
    options.independentPixels = true;
    std::uint32_t seed = 100;
    for (const char* extension : {".grid", ".vol"}) {
        const std::filesystem::path converted = folder_.path() / (std::string("converted") + extension);
        writeVolume(converted, volume);
        const ImageAgreement agreement = testAgreement(see(converted, seed += 100), original, options);
        fmt::print("{} as {}: {}", GetParam(), extension, describe(agreement));
        EXPECT_TRUE(agreement.agree());
        EXPECT_LT(agreement.means.smallestBias, 0.02);  // the test has power
    }
}

INSTANTIATE_TEST_SUITE_P(Files, VolumeFormats,
                         testing::Values("wdas_cloud_sixteenth.vdb", "smoke.vol", "teapot_cloud.nvdb"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::ranges::replace_if(
                                 name, [](char c) { return c == '_' || c == '.'; }, 'X');
                             return name;
                         });

}  // namespace
}  // namespace parhelion
