#include "scene/read_integrator.h"

#include <algorithm>

namespace parhelion {
namespace {

constexpr std::int64_t kMostSamples = 1'000'000;
constexpr std::int64_t kDeepest = 1'000'000'000;
constexpr std::int64_t kMostDepthLayers = IntegratorDescription::kMostDepthLayers;

/// Accepts how Mitsuba's integrators divide their work, and when they give up (timeout: seconds, never unless > 0).
void readExecution(ReadContext& context, PropertyReader& reader) {
    for (const char* name : {"samples_per_pass", "block_size"})
        if (reader.has(name)) {
            reader.integer(name, 0, 0, kDeepest);
            context.note(reader.whereOf(name), fmt::format("\"{}\" has no effect", name));
        }
    if (reader.number("timeout", -1.0) > 0.0)
        context.note(reader.whereOf("timeout"),
                     "\"timeout\" has no effect: rendering ends when all samples are taken (or by Ctrl-C)");
}

/// The integrator that renders: `element` itself, or what a "moment" holds.
const XmlElement& unwrapMoment(ReadContext& context, const XmlElement& element) {
    if (element.require("type").value != "moment") return element;
    PropertyReader reader(context.tree, element);
    const auto inner = reader.onlyNested("integrator");
    if (!inner) reader.fail(element.where, "needs a nested <integrator>: direct, path, volpath or volpathmis");
    if (inner->element->require("type").value == "moment")
        reader.fail(inner->where, "cannot hold another \"moment\"; it takes direct, path, volpath or volpathmis");
    readExecution(context, reader);
    if (reader.boolean("hide_emitters", false))
        context.note(reader.whereOf("hide_emitters"),
                     "\"hide_emitters\" has no effect here, as in Mitsuba: the nested integrator's counts");
    reader.finish();
    return *inner->element;
}

/// What `strategy` and Mitsuba's three numbers of samples say; each way excludes the others.
void readStrategy(ReadContext& context, PropertyReader& reader, IntegratorDescription& integrator) {
    const bool hasShading = reader.has("shading_samples");
    const bool hasCounts = reader.has("emitter_samples") || reader.has("bsdf_samples");
    if (reader.has("strategy") && (hasShading || hasCounts))
        reader.fail(reader.whereOf("strategy"), "give either \"strategy\" or numbers of samples, not both");
    if (hasShading && hasCounts)
        reader.fail(reader.whereOf("shading_samples"),
                    "give either \"shading_samples\" or \"emitter_samples\" and \"bsdf_samples\", not both");
    const std::string strategy = reader.choice("strategy", "mis", {"bsdf", "emitter", "mis"});
    const std::int64_t shading = reader.integer("shading_samples", 1, 1, kMostSamples);
    const std::int64_t emitter = reader.integer("emitter_samples", strategy == "bsdf" ? 0 : shading, 0, kMostSamples);
    const std::int64_t bsdf = reader.integer("bsdf_samples", strategy == "emitter" ? 0 : shading, 0, kMostSamples);
    if (emitter + bsdf == 0)
        reader.fail(reader.whereOf("emitter_samples"), "\"emitter_samples\" or \"bsdf_samples\" must be at least 1");
    for (const char* name : {"shading_samples", "emitter_samples", "bsdf_samples"})
        if (reader.has(name) && std::max(emitter, bsdf) > 1)
            context.note(reader.whereOf(name),
                         fmt::format("\"{}\" only weighs the strategies: a path takes one sample of each, whose number "
                                     "the sampler sets",
                                     name));
    integrator.emitterSamples = double(emitter);
    integrator.scatterSamples = double(bsdf);
}

void readDepth(PropertyReader& reader, IntegratorDescription& integrator) {
    integrator.maxDepth = reader.integer("max_depth", -1, -1, kDeepest);
    integrator.rouletteDepth = reader.integer("rr_depth", 5, 1, kDeepest);
}

}  // namespace

void readIntegrator(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, unwrapMoment(context, element));
    IntegratorDescription& integrator = context.scene.integrator;
    if (reader.type() == "aov")
        reader.fail(reader.where(),
                    "is not supported: albedo, normal and depth are rendered without asking; use the "
                    "integrator inside it: direct, path, volpath, volpathmis");
    if (reader.type() == "direct" || reader.type() == "path")
        integrator.type = reader.type();
    else if (reader.type() == "volpath" || reader.type() == "volpathmis")
        integrator.type = "volpath";
    else
        reader.rejectType({"direct", "path", "volpath", "volpathmis", "moment"});

    if (integrator.type == "direct") {
        integrator.maxDepth = 2;
        readStrategy(context, reader, integrator);
    } else {
        readDepth(reader, integrator);
    }
    integrator.depthLayers = unsigned(reader.integer("depth_layers", 0, 0, kMostDepthLayers));
    if (reader.type() == "volpathmis" && reader.has("use_spectral_mis")) {
        reader.boolean("use_spectral_mis", true);
        context.note(reader.whereOf("use_spectral_mis"), "\"use_spectral_mis\" has no effect on the mean");
    }
    if (reader.boolean("hide_emitters", false))
        reader.fail(reader.whereOf("hide_emitters"), "\"hide_emitters\" must be false; hiding lights is not supported");
    readExecution(context, reader);
    reader.finish();
}

}  // namespace parhelion
