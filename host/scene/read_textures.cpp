#include "scene/read_textures.h"

#include "scene/read_bitmaps.h"
#include "scene/transforms.h"

namespace parhelion {
namespace {

/// Mitsuba takes a transform of space and keeps what it does to x and y: the upper left 2 x 2 matrix, and the
/// translation.
glm::dmat3 readUvTransform(ReadContext& context, PropertyReader& reader) {
    const PropertyReader::Transform transform = reader.flatTransform("to_uv");
    const glm::dmat4& m = transform.matrix;
    if (m[2][0] != 0.0 || m[2][1] != 0.0)
        context.note(transform.where,
                     "of \"to_uv\" only the first two and the fourth column count, as in Mitsuba; a translation is the "
                     "last column of 16 numbers");
    return {m[0][0], m[0][1], 0.0, m[1][0], m[1][1], 0.0, m[3][0], m[3][1], 1.0};
}

void readBitmapTexture(ReadContext& context, PropertyReader& reader, TextureDescription& texture) {
    using Wrap = TextureDescription::Wrap;
    texture.type = TextureDescription::Type::Bitmap;
    texture.nearest = reader.choice("filter_type", "bilinear", {"bilinear", "nearest"}) == "nearest";
    const std::string wrap = reader.choice("wrap_mode", "repeat", {"repeat", "mirror", "clamp"});
    texture.wrap = wrap == "repeat" ? Wrap::Repeat : wrap == "mirror" ? Wrap::Mirror : Wrap::Clamp;
    const bool isRaw = reader.boolean("raw", false);
    reader.boolean("accel", true);  // of Mitsuba's lookups on a GPU
    const std::string format = reader.choice("format", "variant", {"variant", "auto", "float16", "fp16", "uint8"});
    if (format != "variant" && format != "auto")
        context.note(reader.whereOf("format"), "\"format\" has no effect: texels are kept in single precision");
    texture.uvTransform = readUvTransform(context, reader);
    const std::filesystem::path file = reader.file("filename");
    reader.finish();
    texture.bitmap = readTextureBitmap(context, file, reader.whereOf("filename"), isRaw);
}

glm::dvec3 readCheckerColor(PropertyReader& reader, std::string_view name, double fallback) {
    if (const auto nested = reader.namedNested(name, "texture"))
        reader.fail(nested->where,
                    fmt::format("\"{}\" must be a colour (<rgb>, <float> or <spectrum>); textures within "
                                "textures are not supported",
                                name));
    return reader.color(name, fallback, kNonNegative);
}

void readCheckerboard(ReadContext& context, PropertyReader& reader, TextureDescription& texture) {
    texture.type = TextureDescription::Type::Checkerboard;
    texture.color0 = readCheckerColor(reader, "color0", 0.4);
    texture.color1 = readCheckerColor(reader, "color1", 0.2);
    texture.uvTransform = readUvTransform(context, reader);
    reader.finish();
}

}  // namespace

TexturedColor readTexturedColor(ReadContext& context, PropertyReader& reader, std::string_view name, double fallback,
                                const NumberRange& range, ColorRole role) {
    if (const auto nested = reader.namedNested(name, "texture"))
        return {glm::dvec3(1.0), textureIndex(context, *nested->element)};
    return {reader.color(name, fallback, range, role), std::nullopt};
}

std::size_t textureIndex(ReadContext& context, const XmlElement& element) {
    if (const auto found = context.textureIndices.find(&element); found != context.textureIndices.end())
        return found->second;
    PropertyReader reader(context.tree, element);
    TextureDescription texture;
    texture.where = reader.where();
    if (reader.type() == "bitmap")
        readBitmapTexture(context, reader, texture);
    else if (reader.type() == "checkerboard")
        readCheckerboard(context, reader, texture);
    else
        reader.rejectType({"bitmap", "checkerboard"});
    const std::size_t index = context.scene.textures.size();
    context.scene.textures.push_back(std::move(texture));
    return context.textureIndices[&element] = index;
}

}  // namespace parhelion
