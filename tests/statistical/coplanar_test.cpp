#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

#include "analysis/statistics.h"
#include "support/rendering.h"
#include "support/temporary_folder.h"

// A medium that stands on a reflecting floor, its bottom in the floor's plane: each of the two may be met first.
namespace parhelion {
namespace {

using namespace test;

/// A box as an OBJ file, outward triangles, y from -1 to 0.
std::string boxMesh(double halfWidth) {
    std::string text;
    for (int i = 0; i < 8; ++i)
        text +=
            fmt::format("v {} {} {}\n", i & 1 ? halfWidth : -halfWidth, i & 2 ? 0 : -1, i & 4 ? halfWidth : -halfWidth);
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

std::string floorMesh(double halfWidth) {
    return fmt::format("v {0} -1 {0}\nv {0} -1 {1}\nv {1} -1 {1}\nv {1} -1 {0}\nf 1 2 3 4\n", -halfWidth, halfWidth);
}

struct Stand {
    bool meshMedium = true, meshFloor = true;
    double scale = 1;
};

constexpr double kReflectance = 0.8;

/// An isotropic slab of optical depth 1 that absorbs nothing, 200 mean free paths wide, on a Lambertian floor, under a
/// uniform sky; the camera looks straight down.
CompiledScene standing(const Stand& stand) {
    const TemporaryFolder folder;
    folder.write("box.obj", boxMesh(100));
    folder.write("floor.obj", floorMesh(150));
    const std::string scale = fmt::format("<scale value=\"{}\"/></transform>", stand.scale);
    const std::string mesh =
        R"(<shape type="obj"><boolean name="face_normals" value="true"/><string name="filename" value=")";
    const std::string medium =
        (stand.meshMedium
             ? mesh + R"(box.obj"/><transform name="to_world">)"
             : std::string(R"(<shape type="cube"><transform name="to_world"><scale x="100" y="0.5" z="100"/>
        <translate y="-0.5"/>)")) +
        scale + R"(<bsdf type="null"/><ref name="interior" id="slab"/></shape>)";
    const std::string floor =
        (stand.meshFloor ? mesh + R"(floor.obj"/><transform name="to_world">)"
                         : std::string(R"(<shape type="rectangle"><transform name="to_world">
        <rotate x="1" angle="-90"/><scale x="150" z="150"/><translate y="-1"/>)")) +
        scale +
        fmt::format(R"(<bsdf type="diffuse"><float name="reflectance" value="{}"/></bsdf></shape>)", kReflectance);
    const std::string text = fmt::format(
        R"(<scene version="3.0.0"><integrator type="volpath"><integer name="rr_depth" value="64"/></integrator>
        <emitter type="constant"><float name="radiance" value="1"/></emitter>
        <sensor type="perspective"><float name="fov" value="0.1"/><transform name="to_world">
        <lookat origin="{0}, {1}, {2}" target="{0}, 0, {2}" up="0, 0, 1"/></transform><film type="hdrfilm">
        <integer name="width" value="64"/><integer name="height" value="64"/><rfilter type="box"/></film></sensor>
        <medium type="homogeneous" id="slab"><float name="sigma_t" value="{3}"/><float name="albedo" value="1"/></medium>
        {4}{5}</scene>)",
        0.37 * stand.scale, stand.scale, 0.11 * stand.scale, 1 / stand.scale, medium, floor);
    return compileScene(readScene(folder.write("scene.xml", text)));
}

/// What the slab over the floor reflects of light from straight above: R + T r t / (1 - r R'), with the slab's
/// R and T for that light and R', t for diffuse light from below (adding-doubling).
double exactReflectance() {
    constexpr double kReflected = 0.341329, kDiffusely = 0.446594;
    return kReflected + (1 - kReflected) * kReflectance * (1 - kDiffusely) / (1 - kReflectance * kDiffusely);
}

class Coplanar : public testing::TestWithParam<std::tuple<Backend, double>> {};

TEST_P(Coplanar, MediaLoseNothingToTheFloorTheyStandOn) {
    const auto [backend, scale] = GetParam();
    constexpr std::size_t kTests = 24;
    const double threshold = twoSidedThreshold(sidak(1e-6, kTests));
    for (const bool meshMedium : {false, true})
        for (const bool meshFloor : {false, true}) {
            // The variance is exact (1 - exact): 0.5 % is found with power 0.99 from 8 / 0.005 squared times (1 / exact
            // - 1).
            const double exact = exactReflectance();
            const double paths = std::pow(detectableDeviation(threshold) / 0.005, 2) * (1 / exact - 1);
            const Film film = renderOn(backend, standing({meshMedium, meshFloor, scale}),
                                       std::uint64_t(std::ceil(paths / (64 * 64))));
            const PixelEstimate found = imageMean(film);
            const double z = (found.mean - exact) / found.error;
            fmt::print("{} medium, {} floor: {:.6f} +- {:.6f}, exact {:.6f}, z {:+.2f}\n", meshMedium ? "mesh" : "cube",
                       meshFloor ? "mesh" : "rectangle", found.mean, found.error, exact, z);
            EXPECT_LE(std::abs(z), threshold) << meshMedium << meshFloor;
            EXPECT_EQ(countAnomalies(film), 0u);
        }
}

constexpr double kScales[] = {1e-3, 1.0, 1e3};
INSTANTIATE_TEST_SUITE_P(OnTheDevice, Coplanar,
                         testing::Combine(testing::Values(Backend::Vulkan), testing::ValuesIn(kScales)));
INSTANTIATE_TEST_SUITE_P(NightlyOnTheReference, Coplanar,
                         testing::Combine(testing::Values(Backend::Reference), testing::ValuesIn(kScales)));

}  // namespace
}  // namespace parhelion
