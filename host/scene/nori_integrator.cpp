#include "scene/nori_integrator.h"

namespace parhelion {
namespace {

void setStrategy(IntegratorDescription& integrator, const std::string& strategy) {
    integrator.type = "direct";
    integrator.maxDepth = 2;
    integrator.emitterSamples = strategy == "bsdf" ? 0.0 : 1.0;
    integrator.scatterSamples = strategy == "emitter" ? 0.0 : 1.0;
}

}  // namespace

void readNoriIntegrator(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    IntegratorDescription& integrator = context.scene.integrator;
    if (reader.type() == "direct")
        setStrategy(integrator, reader.choice("strategy", "mis", {"bsdf", "emitter", "mis"}));
    else if (reader.type() == "direct_mats")
        setStrategy(integrator, "bsdf");
    else if (reader.type() == "direct_ems")
        setStrategy(integrator, "emitter");
    else if (reader.type() == "direct_mis")
        setStrategy(integrator, "mis");
    else if (reader.type() == "path_mis")
        integrator.type = "path";
    else if (reader.type() == "path_mis_vol")
        integrator.type = "volpath";
    else
        reader.rejectType({"direct", "path_mis", "path_mis_vol", "direct_mats", "direct_ems", "direct_mis"});
    if (integrator.type != "direct") {
        constexpr std::int64_t kDeepest = 1'000'000'000;
        integrator.maxDepth = reader.integer("maxDepth", -1, -1, kDeepest);
        integrator.rouletteDepth = reader.integer("rrDepth", 5, 1, kDeepest);
    }
    integrator.depthLayers =
        unsigned(reader.integer("depthLayers", 0, 0, std::int64_t{IntegratorDescription::kMostDepthLayers}));
    reader.finish();
}

}  // namespace parhelion
