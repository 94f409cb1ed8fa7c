#include "exact_pruning.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "render/renderer.h"
#include "support/gpu_fixture.h"
#include "support/render_scene.h"
#include "support/rendering.h"

namespace parhelion::test {
namespace {

constexpr std::uint64_t kSamples = 4;

/// A film and the device time a sample per pixel took, without the first dispatch, which waits for the compiler;
/// nothing where that was all.
struct TimedFilm {
    Film film;
    std::optional<double> msPerPass;
};

std::string timeText(const TimedFilm& timed) {
    return timed.msPerPass ? fmt::format("{:8.2f} ms a pass", *timed.msPerPass) : "in one dispatch";
}

TimedFilm renderTimed(const CompiledScene& scene, const EffectSet& effects) {
    RenderSettings settings = settingsFor(scene, kSamples);
    settings.effects = effects;
    render::Renderer renderer(testDevice(), scene, settings);
    bool more = renderer.step();
    const double first = renderer.progress().samplesDone;
    double ms = 0;
    while (more) {
        more = renderer.step();
        ms += renderer.progress().dispatchMs;
    }
    const double paths = renderer.progress().samplesDone - first;
    const double pixels = double(scene.cropSize.x) * scene.cropSize.y;
    return {renderer.film(), paths > 0 ? std::optional(ms * pixels / paths) : std::nullopt};
}

/// The effects, each alone added to the scene's own, that change the film.
std::string guiltyEffects(const CompiledScene& scene, const Film& own) {
    std::string names;
    const char* labels[] = {
#define X(name, id, label) #name,
        PARHELION_EFFECTS(X)
#undef X
    };
    for (unsigned effect = 0; effect < kEffectCount; ++effect) {
        if (scene.effects.on[effect]) continue;
        EffectSet more = scene.effects;
        more.on.set(effect);
        if (countDifferentPixels(own, renderTimed(scene, more).film) != 0) names += fmt::format(" {}", labels[effect]);
    }
    return names.empty() ? " none alone" : names;
}

}  // namespace

void expectExactPruning(const std::string& name, const CompiledScene& scene) {
    const TimedFilm own = renderTimed(scene, scene.effects), all = renderTimed(scene, EffectSet::all());
    fmt::print("{:44} {:2} effects {}, all {}\n", name, scene.effects.on.count(), timeText(own), timeText(all));
    EXPECT_EQ(countAnomalies(own.film), 0u) << name;
    EXPECT_EQ(countAnomalies(all.film), 0u) << name;
    EXPECT_EQ(countDifferentFeatures(own.film, all.film), 0u) << name;
    const std::size_t different = countDifferentPixels(own.film, all.film);
    EXPECT_EQ(different, 0u) << name << ", of " << own.film.pixels.size() << " pixels; changed by"
                             << guiltyEffects(scene, own.film);
}

Film renderWithEffects(const CompiledScene& scene, const EffectSet& effects) {
    return renderTimed(scene, effects).film;
}

}  // namespace parhelion::test
