#include "scene/read_bsdf.h"

#include "scene/read_textures.h"

namespace parhelion {
namespace {

BsdfDescription readTwoSided(ReadContext& context, PropertyReader& reader) {
    const auto inner = reader.onlyNested("bsdf");
    if (!inner) reader.fail(reader.where(), "needs one nested <bsdf type=\"diffuse\">");
    if (inner->element->require("type").value != "diffuse")
        reader.fail(inner->where,
                    fmt::format("can only hold a \"diffuse\" BSDF; got \"{}\"", inner->element->require("type").value));
    BsdfDescription bsdf = readBsdf(context, *inner->element);
    bsdf.twoSided = true;
    return bsdf;
}

}  // namespace

BsdfDescription readBsdf(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    BsdfDescription bsdf;
    if (reader.type() == "diffuse") {
        const TexturedColor reflectance = readTexturedColor(context, reader, "reflectance", 0.5, kUnitInterval);
        bsdf.reflectance = reflectance.color;
        bsdf.texture = reflectance.texture;
    } else if (reader.type() == "null") {
        bsdf.type = BsdfDescription::Type::Null;
    } else if (reader.type() == "twosided") {
        bsdf = readTwoSided(context, reader);
    } else {
        reader.rejectType({"diffuse", "null", "twosided"});
    }
    bsdf.where = reader.where();
    reader.finish();
    return bsdf;
}

}  // namespace parhelion
