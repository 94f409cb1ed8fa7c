#include "app/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cloud_reports.h"
#include "app/exit_codes.h"
#include "app/output_check.h"
#include "app/process_start.h"
#include "app/render_backends.h"
#include "app/render_outputs.h"
#include "app/text_format.h"
#include "base/memory.h"
#include "compile/compile_scene.h"
#include "gpu/cache.h"

namespace parhelion::app {

namespace {

/// Reads the scene, none of whose files may be an output.
SceneDescription readSceneBeside(const OutputFiles& files, const RenderArguments& arguments) {
    SceneDescription description = readScene(arguments.scene);
    for (const std::filesystem::path& file : files.all())
        refuseReplacing(description.files, file, file == files.report ? "--report" : "--output");
    return description;
}

void refuseVulkanOptions(const RenderArguments& arguments) {
    const auto refuse = [&arguments](const char* option, bool given) {
        if (given)
            throw InputError(fmt::format("{}: only --backend {} has it; got --backend {}", option,
                                         nameOf(Backend::Vulkan), nameOf(arguments.backend)));
    };
    refuse("--device", !arguments.device.empty());
    refuse("--vector-bits", arguments.vectorBits.has_value());
    refuse("--effects", arguments.allEffects.has_value());
    refuse("--steps-per-event", arguments.stepsPerEvent.has_value());
    refuse("--error", arguments.error.has_value());
    refuse("--time", arguments.seconds.has_value());
    refuse("--save-every", arguments.saveSeconds.has_value());
}

void requireInside(const PixelRect& crop, glm::uvec2 film) {
    if (crop.offset.x + crop.size.x > film.x || crop.offset.y + crop.size.y > film.y)
        throw InputError(fmt::format("--crop: must lie inside the film of {}; got {},{},{}", formatSize(film),
                                     crop.offset.x, crop.offset.y, formatSize(crop.size)));
}

/// The system may promise more memory than there is and end the process when it is used: ask first.
void requireMemory(glm::uvec2 pixels, std::uint32_t depthLayers) {
    constexpr std::size_t kImageChannels = 16;  // those of toImage and of the error
    // The film is held by the back end, with two copies of it as it was, and, at the end, copied from it, once more
    // where it is written on the way. What judges pixels lists them.
    constexpr double kJudged = 130;
    constexpr double kBytesPerPixel =
        kJudged + 5 * sizeof(shared::FilmPixel) + 2 * sizeof(shared::FeaturePixel) + kImageChannels * sizeof(float);
    const double layerBytes = (4.0 * sizeof(shared::LayerPixel) + 3 * sizeof(float)) * depthLayers;
    const double needed = (kBytesPerPixel + layerBytes) * pixels.x * pixels.y;
    const double allowed = 0.5 * static_cast<double>(physicalMemoryBytes());
    if (needed > allowed)
        throw InputError(fmt::format(
            "film of {}{} needs {}, half of the memory is {}: --size or --crop make it smaller{}", formatSize(pixels),
            depthLayers > 0 ? fmt::format(" with {} depth layers", depthLayers) : "", formatBytes(needed),
            formatBytes(allowed), depthLayers > 0 ? ", so do fewer --depth-layers" : ""));
}

CompiledScene compile(const RenderArguments& arguments, const SceneDescription& description) {
    CompileOptions options;
    options.size = arguments.scene.size;
    options.maxDepth = arguments.maxDepth;
    if (arguments.depthLayers) options.depthLayers = static_cast<unsigned>(*arguments.depthLayers);
    options.sampleEveryLight = arguments.sampleEveryLight;
    if (arguments.crop) {
        requireInside(*arguments.crop, arguments.scene.size.value_or(description.film.size));
        options.cropOffset = arguments.crop->offset;
        options.cropSize = arguments.crop->size;
    }
    return compileScene(description, options);
}

/// Paths through media alone are too many-dimensional for stratified points: the same variance, at 15 % more time.
bool gainsFromSobol(const EffectSet& effects) {
    return effects.has(Effect::hasSurfaces) || effects.has(Effect::hasAreaLights) ||
           effects.has(Effect::hasEnvironmentSampling);
}

RenderSettings chooseSettings(const RenderArguments& arguments, const CompiledScene& scene) {
    RenderSettings settings;
    const std::uint64_t otherwise = arguments.error || arguments.seconds ? kUnlimitedSamples : scene.sampleCount;
    settings.sampleCount = arguments.sampleCount ? static_cast<std::uint64_t>(*arguments.sampleCount) : otherwise;
    settings.seed = arguments.seed ? static_cast<std::uint32_t>(*arguments.seed) : scene.seed;
    settings.featureSamples = arguments.featureSamples;
    settings.quality = arguments.quality;
    if (arguments.stepsPerEvent) settings.quality.stepsPerEvent = *arguments.stepsPerEvent;
    settings.quality.sobol = arguments.sobol.value_or(gainsFromSobol(scene.effects));
    settings.controls = chooseControlPixels(scene.cropSize, settings.seed);
    settings.effects = arguments.allEffects.value_or(false) ? EffectSet::all() : scene.effects;
    return settings;
}

/// Opens the device, if one is to render. The more lanes a vector has, the longer they wait for each other in a mesh's
/// BVH: 8 are faster than 16 there (by a third on a lit bunny, by a fifth on a cloud among arches).
/// @throws InputError for a name that fits none.
std::unique_ptr<gpu::Device> openDevice(const RenderArguments& arguments, const SceneDescription& description) {
    if (arguments.backend != Backend::Vulkan) return nullptr;
    const bool hasMesh = std::ranges::any_of(
        description.shapes, [](const ShapeDescription& shape) { return shape.type == ShapeDescription::Type::Mesh; });
    return std::make_unique<gpu::Device>(gpu::DeviceOptions{.name = arguments.device,
                                                            .vectorBits = arguments.vectorBits.value_or(0),
                                                            .preferredVectorBits = hasMesh ? 256u : 512u});
}

std::vector<CloudBakeReport> bake(const RenderArguments& arguments, gpu::Device* device,
                                  SceneDescription& description) {
    return bakeClouds(description, device ? deviceBaker(*device) : twinBaker(), {.measureError = arguments.bakeError});
}

/// Judging the pixels and writing takes time as well: on the safe side.
double secondsToWrite(const CompiledScene& scene) {
    constexpr double kPerPixel = 2.5e-6, kPerLayer = 0.3e-6, kEver = 0.1;
    return kEver + static_cast<double>(scene.cropSize.x) * scene.cropSize.y *
                       (kPerPixel + kPerLayer * scene.constants.depthLayers);
}

RenderTargets targetsOf(const RenderArguments& arguments, const CompiledScene& scene) {
    RenderTargets targets{.error = arguments.error, .norm = arguments.errorNorm, .deadline = {}};
    if (arguments.seconds)
        targets.deadline =
            processStart() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                 std::chrono::duration<double>(*arguments.seconds - secondsToWrite(scene)));
    return targets;
}

/// Pictures on the way, if asked for.
IntermediateFiles intermediateFiles(const RenderArguments& arguments, const RenderOutputs& outputs) {
    if (!arguments.saveSeconds) return {};
    return {.seconds = *arguments.saveSeconds,
            .write = [outputs](const RenderOutcome& outcome) { return outputs.write(outcome).png; }};
}

RenderOutcome runBackend(const RenderArguments& arguments, gpu::Device* device, const CompiledScene& scene,
                         const RenderSettings& settings, const RenderOutputs& outputs, Interruption& interruption,
                         ProgressDisplay& progress) {
    switch (arguments.backend) {
        case Backend::Reference:
            return renderWithReference<float>(scene, settings, interruption, progress);
        case Backend::ReferenceDouble:
            return renderWithReference<double>(scene, settings, interruption, progress);
        case Backend::Vulkan:
            break;
    }
    return renderWithVulkan(*device, scene, settings, targetsOf(arguments, scene),
                            intermediateFiles(arguments, outputs), interruption, progress);
}

/// The device stops the render itself on these; the reference leaves them to its caller.
void requireCompleteTraversals(const Film& film) {
    if (film.counters[shared::kCounterBvhOverflow] > 0 || film.counters[shared::kCounterLoopTruncated] > 0)
        throw RuntimeFailure(fmt::format("{} traversals and {} loops were cut short: the image would be wrong",
                                         film.counters[shared::kCounterBvhOverflow],
                                         film.counters[shared::kCounterLoopTruncated]));
}

int judge(const RenderArguments& arguments, const RenderReport& report) {
    if (report.interrupted()) return kExitInterrupted;
    if (!report.hasAnomalies() || arguments.allowAnomalies) return kExitSuccess;
    fmt::print(stderr,
               "parhelion: error: the image was written, but samples were dropped, majorants violated or values out of "
               "the range of its 32-bit channels (scale the lights); --allow-anomalies accepts it\n");
    return kExitFailed;
}

}  // namespace

int runRenderCommand(const RenderArguments& arguments) {
    Interruption interruption;
    if (arguments.backend != Backend::Vulkan) refuseVulkanOptions(arguments);
    const OutputFiles files = prepareOutputs(arguments);
    SceneDescription description = readSceneBeside(files, arguments);
    const std::unique_ptr<gpu::Device> device = openDevice(arguments, description);
    std::vector<CloudBakeReport> clouds = bake(arguments, device.get(), description);
    const CompiledScene scene = compile(arguments, description);
    requireMemory(scene.cropSize, scene.constants.depthLayers);
    const RenderSettings settings = chooseSettings(arguments, scene);
    if (const std::string note = device ? gpu::cacheNote() : ""; !arguments.quiet && !note.empty())
        fmt::print(stderr, "parhelion: note: {}\n", note);
    if (!arguments.quiet)
        for (const std::string& note : scene.notes) fmt::print(stderr, "parhelion: note: {}\n", note);
    ProgressDisplay progress(stderr, arguments.quiet);
    const RenderOutputs outputs{arguments, files, scene, settings, clouds, interruption};
    const RenderOutcome outcome = runBackend(arguments, device.get(), scene, settings, outputs, interruption, progress);
    requireCompleteTraversals(outcome.film);
    if (outcome.film.samples == 0) {
        fmt::print(stderr, "parhelion: interrupted before the first samples were done; nothing was written\n");
        return kExitInterrupted;
    }
    const RenderReport report = outputs.write(outcome);
    if (arguments.json)
        printJson(toJson(report));
    else if (!arguments.quiet)
        fmt::print("{}", describe(report));
    return judge(arguments, report);
}

}  // namespace parhelion::app
