#include "scene/read_integrator.h"

namespace parhelion {
namespace {

/// The integrator that renders: `element` itself, or what a "moment" holds.
const XmlElement& unwrapMoment(const ReadContext& context, const XmlElement& element) {
    if (element.require("type").value != "moment") return element;
    PropertyReader reader(context.tree, element);
    const auto inner = reader.onlyNested("integrator");
    if (!inner) reader.fail(element.where, "needs a nested <integrator>: path, volpath or volpathmis");
    reader.finish();
    return *inner->element;
}

}  // namespace

void readIntegrator(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, unwrapMoment(context, element));
    IntegratorDescription& integrator = context.scene.integrator;
    if (reader.type() == "aov")
        reader.fail(reader.where(),
                    "is not supported: albedo, normal and depth are rendered without asking; use the "
                    "integrator inside it: path, volpath, volpathmis");
    if (reader.type() == "path")
        integrator.type = "path";
    else if (reader.type() == "volpath" || reader.type() == "volpathmis")
        integrator.type = "volpath";
    else
        reader.rejectType({"path", "volpath", "volpathmis", "moment"});

    constexpr std::int64_t kDeepest = 1'000'000'000;
    integrator.maxDepth = reader.integer("max_depth", -1, -1, kDeepest);
    integrator.rouletteDepth = reader.integer("rr_depth", 5, 1, kDeepest);
    if (reader.boolean("hide_emitters", false))
        reader.fail(reader.whereOf("hide_emitters"), "\"hide_emitters\" must be false; hiding lights is not supported");
    for (const char* name : {"samples_per_pass", "block_size"})
        if (reader.has(name)) {
            reader.integer(name, 0, 0, kDeepest);
            context.note(reader.whereOf(name), fmt::format("\"{}\" has no effect", name));
        }
    reader.finish();
}

}  // namespace parhelion
