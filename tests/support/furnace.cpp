#include "furnace.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics.h"
#include "image/film_image.h"
#include "scene/scene_description.h"
#include "support/temporary_folder.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

constexpr unsigned kResolution = 20;  // not whole majorant cells of 8

/// Density in [0, 1] with hollows and peaks in every majorant cell; its mean is 0.25.
float densityAt(glm::uvec3 voxel) {
    double product = 2;
    for (int i = 0; i < 3; ++i) product *= 0.5 + 0.5 * std::cos(2 * 3.14159265358979 * (voxel[i] + 0.5) / 5);
    return static_cast<float>(product / 2);
}

double writeGrid(const std::filesystem::path& file) {
    Volume volume;
    volume.density = DensityGrid(glm::uvec3(kResolution));
    double sum = 0;
    for (unsigned z = 0; z < kResolution; ++z)
        for (unsigned y = 0; y < kResolution; ++y)
            for (unsigned x = 0; x < kResolution; ++x) {
                volume.density.set({x, y, z}, densityAt({x, y, z}));
                sum += densityAt({x, y, z});
            }
    writeVolume(file, volume);
    return sum / (kResolution * kResolution * kResolution);
}

std::string extinctionText(const Furnace& furnace, const TemporaryFolder& folder) {
    const double sigma = furnace.tau / 2;
    if (!furnace.isGrid)
        return fmt::format(R"(<rgb name="sigma_t" value="{}, {}, {}"/>)", sigma * furnace.red, sigma, sigma);
    const double meanDensity = writeGrid(folder.path() / "density.grid");
    return fmt::format(R"(<float name="scale" value="{}"/>
        <volume name="sigma_t" type="gridvolume"><string name="filename" value="density.grid"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>)",
                       sigma / meanDensity);
}

std::string sceneText(const Furnace& furnace, const TemporaryFolder& folder) {
    return fmt::format(R"(<scene version="3.0.0"><integrator type="volpath"/>
        <sensor type="perspective"><float name="fov" value="20"/>
        <transform name="to_world"><lookat origin="1, 0.8, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="{0}"/><integer name="height" value="{0}"/>
        <rfilter type="box"/></film></sensor>
        <emitter type="constant"><float name="radiance" value="1"/></emitter>
        <shape type="{1}"><bsdf type="null"/>
        <medium name="interior" type="{2}">{3}<float name="albedo" value="1"/>
        <phase type="hg"><float name="g" value="{4}"/></phase></medium></shape></scene>)",
                       furnace.size, furnace.isGrid ? "cube" : "sphere",
                       furnace.isGrid ? "heterogeneous" : "homogeneous", extinctionText(furnace, folder), furnace.g);
}

}  // namespace

std::string name(const Furnace& furnace) {
    return fmt::format("{} of optical thickness {}, g {}", furnace.isGrid ? "grid" : "sphere", furnace.tau, furnace.g);
}

CompiledScene furnaceScene(const Furnace& furnace) {
    const TemporaryFolder folder;
    CompileOptions options;
    options.sampleEveryLight = furnace.sampleSky;
    return compileScene(readScene(folder.write("furnace.xml", sceneText(furnace, folder))), options);
}

void expectWhite(Backend backend, const Furnace& furnace) {
    const Film film = renderOn(backend, furnaceScene(furnace), 256);
    EXPECT_EQ(countAnomalies(film), 0u) << name(furnace);
    EXPECT_GT(film.counters[shared::kCounterVertices], 0u) << name(furnace);
    const Image image = toImage(film);
    for (const char* channel : {"R", "G", "B"}) {
        const auto& values = image.channels.at(channel);
        const auto [low, high] = std::ranges::minmax_element(values);
        EXPECT_GT(*low, 1 - 1e-4) << name(furnace);
        EXPECT_LT(*high, 1 + 1e-4) << name(furnace);
    }
}

void expectWhiteOnAverage(Backend backend, const Furnace& furnace, std::uint64_t samples, double bias) {
    const Film film = renderOn(backend, furnaceScene(furnace), samples, 1);
    const PixelEstimate found = imageMean(film);
    const double threshold = twoSidedThreshold(1e-6);
    const double z = (found.mean - 1) / found.error, detectable = detectableDeviation(threshold) * found.error;
    fmt::print("{} {}: {:.5f} +- {:.5f}, z {:+.2f}; would have found {:.3f} %\n", name(backend), name(furnace),
               found.mean, found.error, z, 100 * detectable);
    EXPECT_EQ(countAnomalies(film), 0u) << name(furnace);
    EXPECT_LE(std::abs(z), threshold) << name(furnace);
    EXPECT_LE(detectable, bias) << name(furnace);
    EXPECT_GT(found.error, 0) << "without a spread nothing was tested";
}

}  // namespace parhelion::test
