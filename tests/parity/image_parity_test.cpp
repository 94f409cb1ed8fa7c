#include <fmt/format.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/poisson.hpp>
#include <cmath>

#include "base/parallel.h"
#include "reference/integrator/path_tracer.h"
#include "render/path_trace_pass.h"
#include "render/specialise.h"
#include "support/effect_scenes.h"
#include "support/gpu_fixture.h"
#include "support/render_scene.h"

// The device and the reference take the same paths: same random numbers, same decisions, so that their images differ by
// rounding, and by the few paths that rounding sends another way.
//
// How many those are is predicted from the reference alone. A decision compares a random number with a computed
// probability; computed in float and in double, that differs by |dp|, and the chance that a number falls between is
// |dp|. A path diverges with the sum over its decisions. To the recorded ones come those whose odds are known:
// - Corners. A stochastic density lookup compares three uniforms with the fractions of a position in voxels, which
// float
//   knows to 2^-24 times the resolution (three roundings, each half an ulp of up to that).
// - Events. Every event decides whether a collision comes before a plane or boundary, or on which side of an edge a ray
//   passes: an optical depth or a coordinate of order 1 after 8 roundings, 8 * 2^-24.
// - Ill-conditioned paths: the reference in float is itself off by more than the tolerance. How many those may be has a
//   bound of its own (mostIllConditioned).
// - Logarithms. The device's is within an ulp of libm's: 2^-24 of a depth of order 1 for each tentative collision.
namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{48, 48};
constexpr std::uint64_t kSampleIndices[] = {0, 1, 2, 0x100000003ull};
constexpr double kUlp = 0x1p-24;
constexpr double kSignificance = 1e-6;
constexpr std::uint32_t kBudget = 6000;

/// A path's decisions, and how many events it met.
struct CountingTrace : reference::PathTrace {
    void add(reference::PathEvent event, std::uint64_t id) {
        ++events;
        PathTrace::add(event, id);
    }
    void add(const reference::Decision& decision) { PathTrace::add(decision); }

    std::uint32_t events = 0;
};

/// One path as the device and the reference followed it.
struct PathPair {
    glm::dvec3 device, inFloat, inDouble;
    double predicted = 0;  ///< probability of diverging
    std::uint32_t events = 0;
};

/// What sets the paths of a scene apart.
struct Parity {
    std::size_t paths = 0;
    double predicted = 0;                       ///< well-conditioned paths expected to diverge
    std::size_t illConditioned = 0;             ///< paths whose reference in float differs from that in double
    std::size_t fromFloat = 0, fromDouble = 0;  ///< paths that differ from the reference by more than the tolerance
    double worst = 0;                           ///< of the others: largest difference, as a share of the tolerance
    double worstRelative = 0;                   ///< of the others: largest relative difference
    double bias = 0;                            ///< of the others: difference of the means, relative
    double divergedZ = 0;                       ///< sum of the diverged differences over the root of their squares

    /// Divergence may be this frequent: three times the prediction, and chance. Of ill-conditioned paths, too: which
    /// ones rounding takes beyond the tolerance differs from one arithmetic to the next.
    double limit() const {
        const boost::math::poisson distribution(3 * (predicted + double(illConditioned)));
        return quantile(complement(distribution, kSignificance));
    }
    bool passes(double mostIllConditioned) const {
        return double(illConditioned) <= mostIllConditioned && double(fromFloat) <= limit() &&
               double(fromDouble) <= limit() && bias <= 8 * kUlp && divergedZ <= 5.4;
    }
};

/// Traces sample `index` of every pixel; gives the film's sums, all earlier samples included.
std::vector<glm::dvec3> addSample(render::PathTracePass& pass, const CompiledScene& scene, std::uint64_t index) {
    bool restart = true;
    do {
        pass.run(0, {.filmSize = scene.filmSize,
                     .cropOffset = scene.cropOffset,
                     .cropSize = scene.cropSize,
                     .firstPixel = 0,
                     .laneCount = kSize.x * kSize.y,
                     .sampleLow = std::uint32_t(index),
                     .sampleHigh = std::uint32_t(index >> 32),
                     .sampleCount = 1,
                     .seed = 0,
                     .loopBudget = kBudget,
                     .restart = restart,
                     .pauseAt = 0,
                     .stallLimit = shared::kMaximumStall,
                     .imageLanes = kSize.x * kSize.y,
                     .emptyFilm = 0});
        restart = false;
    } while (std::ranges::count(pass.samplesDone(0), 0u) > 0);
    std::vector<glm::dvec3> sums;
    for (const shared::FilmPixel& pixel : pass.film(0)) sums.push_back(sampleSum(pixel));
    return sums;
}

double predictDivergence(const CountingTrace& inFloat, const CountingTrace& inDouble, double corner) {
    double sum = 8 * kUlp * inDouble.events;
    const std::size_t common = std::min(inFloat.decisions.size(), inDouble.decisions.size());
    for (std::size_t i = 0; i < common; ++i) {
        const reference::Decision &a = inFloat.decisions[i], &b = inDouble.decisions[i];
        if (a.kind != b.kind || a.vertex != b.vertex || a.index != b.index) break;  // diverged before
        sum += std::abs(std::clamp(a.probability, 0.0, 1.0) - std::clamp(b.probability, 0.0, 1.0));
        if (a.kind != reference::Decision::Kind::PathRoulette) sum += 3 * corner + kUlp;
    }
    return sum;
}

double cornerError(const CompiledScene& scene) {
    unsigned resolution = 0;
    for (std::uint32_t i = 0; i < scene.constants.mediumCount; ++i)
        if (!(scene.constants.media[i].flags & shared::kMediumHomogeneous))
            for (int axis = 0; axis < 3; ++axis)
                resolution = std::max(resolution, scene.constants.media[i].resolution[axis]);
    return kUlp * resolution;
}

/// The reference's side of sample `index`.
void traceReference(const CompiledScene& scene, std::uint64_t index, std::span<PathPair> paths) {
    const reference::SceneView<float> inFloat(scene);
    const reference::SceneView<double> inDouble(scene);
    const double corner = cornerError(scene);
    parallelFor(kSize.y, [&](std::size_t y) {
        reference::Counters counters{};
        for (std::uint32_t x = 0; x < kSize.x; ++x) {
            PathPair& path = paths[y * kSize.x + x];
            CountingTrace single, twice;
            path.inFloat = reference::tracePath(inFloat, Quality{}, 0, {x, y}, index, counters, single);
            path.inDouble = reference::tracePath(inDouble, Quality{}, 0, {x, y}, index, counters, twice);
            path.predicted = predictDivergence(single, twice, corner);
            path.events = std::max(single.events, twice.events);
        }
    });
}

std::vector<PathPair> tracePaths(const CompiledScene& onDevice, const CompiledScene& onReference) {
    gpu::Device& device = testDevice();
    const render::DeviceScene deviceScene(device, onDevice);
    const render::Batch batch{.firstPixel = 0, .pixelCount = kSize.x * kSize.y};
    render::PathTracePass pass(device, deviceScene, render::specialise(onDevice, onDevice.effects, {}), {&batch, 1}, {},
                               onDevice.constants.depthLayers);
    std::vector<PathPair> all;
    std::vector<glm::dvec3> before(kSize.x * kSize.y, glm::dvec3(0));
    for (const std::uint64_t index : kSampleIndices) {
        std::vector<PathPair> paths(kSize.x * kSize.y);
        const std::vector<glm::dvec3> sums = addSample(pass, onDevice, index);
        traceReference(onReference, index, paths);
        for (std::size_t i = 0; i < paths.size(); ++i) paths[i].device = sums[i] - before[i];
        before = sums;
        all.insert(all.end(), paths.begin(), paths.end());
    }
    return all;
}

double largest(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

/// A path's radiance may be off by 4e-7 for each event and for the camera and the film (three roundings an
/// event, adding up in the worst case), relative to itself, or to the image's mean where it brings less than that: a
/// nearly black path of grazing light is all cancellation.
Parity compare(const std::vector<PathPair>& paths) {
    Parity parity{.paths = paths.size()};
    double mean = 0;
    for (const PathPair& path : paths) mean += largest(path.inDouble) / double(paths.size());
    double bias = 0, diverged = 0, squares = 0;
    for (const PathPair& path : paths) {
        const double scale = std::max(largest(path.inDouble), mean), tolerance = 4e-7 * (path.events + 8.0) * scale;
        const double fromFloat = largest(abs(path.device - path.inFloat));
        const double fromDouble = largest(abs(path.device - path.inDouble));
        const bool known = largest(abs(glm::dvec3(path.inFloat) - path.inDouble)) <= tolerance;
        parity.predicted += known ? path.predicted : 0;
        parity.illConditioned += !known;
        parity.fromFloat += !(fromFloat <= tolerance);
        parity.fromDouble += !(fromDouble <= tolerance);
        const double signedDifference = path.device.y - path.inDouble.y;
        if (fromDouble <= tolerance) {
            parity.worst = std::max(parity.worst, fromDouble / tolerance);
            parity.worstRelative = std::max(parity.worstRelative, fromDouble / scale);
            bias += signedDifference;
        } else {
            diverged += signedDifference;
            squares += signedDifference * signedDifference;
        }
    }
    parity.bias = std::abs(bias) / (mean * double(paths.size()));
    parity.divergedZ = squares > 0 ? std::abs(diverged) / std::sqrt(squares) : 0;
    return parity;
}

/// How many of a scene's paths may be ill-conditioned: what enlarges the few roundings of a place or direction beyond
/// the tolerance, which is a few roundings for each event. Spheres do that to paths that graze them, and every edge to
/// those that pass within rounding of it. Without textures no scene file or effect had more than 18 of 9216, 1 in 500,
/// expected to diverge for whatever reason. A texture multiplies by its texels a unit and their contrast:
/// - an edge between squares of scenes/checkerboard.xml, one texel of 64 wide, 2.2 % of its paths; joints between the
///   stones of scenes/final_cloud.xml, met more than once a path, 5.0 %; 10 % may be;
/// - a map's neighbouring texels anywhere, 512 / 2 pi of them a radian (scenes/bunny_under_sky.xml): 15 %; 25 % may be.
/// Images of those scenes are compared by their bias, too.
double mostIllConditioned(const CompiledScene& scene) {
    const double paths = double(kSize.x) * kSize.y * std::size(kSampleIndices);
    if (scene.effects.has(Effect::hasEnvironmentMap)) return paths / 4;
    if (scene.effects.has(Effect::hasTextures) || scene.effects.has(Effect::hasTexturedLights)) return paths / 10;
    return paths / 500;
}

std::string row(const std::string& name, const Parity& p) {
    const double n = double(p.paths);
    return fmt::format(
        "{:40} {:6} paths, ill-conditioned {:.1e}, predicted {:.1e}, from float {:.1e}, from double {:.1e} (limit "
        "{:.1e}); others "
        "{:.1e} at most, {:3.0f} % of the tolerance; mean off by {:.0e}\n",
        name, p.paths, double(p.illConditioned) / n, p.predicted / n, p.fromFloat / n, p.fromDouble / n, p.limit() / n,
        p.worstRelative, 100 * p.worst, p.bias);
}

void expectParity(const std::string& name, const CompiledScene& scene) {
    const Parity parity = compare(tracePaths(scene, scene));
    fmt::print("{}", row(name, parity));
    EXPECT_LE(double(parity.illConditioned), mostIllConditioned(scene)) << row(name, parity);
    EXPECT_LE(double(parity.fromFloat), parity.limit()) << row(name, parity);
    EXPECT_LE(double(parity.fromDouble), parity.limit()) << row(name, parity);
    // 8 roundings in one direction: systematic errors are smaller than random ones.
    EXPECT_LE(parity.bias, 8 * kUlp) << row(name, parity);
    // Differences of either sign: Hoeffding's bound for their self-normalised sum, 2 exp(-5.4^2 / 2) = 1e-6.
    EXPECT_LE(parity.divergedZ, 5.4) << row(name, parity);
}

TEST(ImageParity, DeviceFollowsTheReferenceInEverySceneFile) {
    ASSERT_FALSE(sceneFiles().empty());
    for (const auto& file : sceneFiles()) expectParity(file.filename(), compileFile(file, kSize));
}

TEST(ImageParity, DeviceFollowsTheReferenceInEveryEffect) {
    const TemporaryFolder folder;
    for (const NamedScene& named : effectScenes(folder, kSize)) expectParity(named.name, named.scene);
}

// What the test would catch: each defect on one side only.
TEST(ImageParity, SmallDefectsShow) {
    const CompiledScene scene = compileFile(sceneFolder() / "sphere_under_sky.xml", kSize);
    const auto withDefect = [&](auto change) {
        CompiledScene changed = scene;
        change(changed);
        const Parity parity = compare(tracePaths(scene, changed));
        return std::pair(parity.passes(mostIllConditioned(scene)), row("defect", parity));
    };
    ASSERT_TRUE(withDefect([](CompiledScene&) {}).first);
    const std::pair<bool, std::string> results[] = {
        withDefect([](CompiledScene& s) { s.constants.media[0].albedo *= 1 - 1e-5f; }),
        withDefect([](CompiledScene& s) { s.constants.media[0].sigmaMax *= 1 + 1e-3f; }),
        withDefect([](CompiledScene& s) { s.constants.media[0].g += 1e-4f; }),
        withDefect([](CompiledScene& s) { s.constants.lights[0].emission *= 1 + 1e-5f; }),
        withDefect([](CompiledScene& s) { s.constants.rouletteDepth -= 8; }),
    };
    for (const auto& [passes, text] : results) EXPECT_FALSE(passes) << text;
}

}  // namespace
}  // namespace parhelion::test
