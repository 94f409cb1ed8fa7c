#include "scene/read_bsdf.h"

#include "scene/read_textures.h"

namespace parhelion {
namespace {

BsdfDescription readTwoSided(ReadContext& context, PropertyReader& reader) {
    const auto sides = reader.nested("bsdf");
    if (sides.empty()) reader.fail(reader.where(), "needs one nested <bsdf type=\"diffuse\">");
    if (sides.size() > 2) reader.fail(sides[2].where, "only two <bsdf> are allowed here: front and back");
    std::vector<BsdfDescription> read;
    for (const PropertyReader::Nested& side : sides) {
        if (const std::string& type = side.element->require("type").value; type != "diffuse")
            reader.fail(side.where, fmt::format("can only hold a \"diffuse\" BSDF; got \"{}\"", type));
        read.push_back(readBsdf(context, *side.element));
    }
    if (read.front().reflectance != read.back().reflectance || read.front().texture != read.back().texture)
        reader.fail(sides.back().where, "the back cannot have a reflectance of its own here; it must be the front's");
    if (reader.has("allow_transmission")) {
        reader.boolean("allow_transmission", false);
        context.note(reader.whereOf("allow_transmission"),
                     "\"allow_transmission\" has no effect: a diffuse BSDF lets nothing through");
    }
    read.front().twoSided = true;
    return read.front();
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
