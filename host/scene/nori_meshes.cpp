#include "scene/nori_meshes.h"

#include "scene/nori_media.h"
#include "scene/obj_mesh.h"
#include "scene/read_bitmaps.h"
#include "scene/transforms.h"

namespace parhelion {
namespace {

/// (u, v) to the bitmap: v is turned over before it is scaled, as where Mitsuba's `flip_tex_coords` meets a `to_uv`.
glm::dmat3 readUvTransform(PropertyReader& reader) {
    const double u = reader.number("uScale", 1.0), v = reader.number("vScale", 1.0);
    const bool flips = reader.boolean("flipV", false);
    glm::dmat3 transform(1.0);
    transform[0][0] = u;
    transform[1][1] = flips ? -v : v;
    transform[2][1] = flips ? v : 0.0;
    return transform;
}

void readTexture(ReadContext& context, PropertyReader& reader, BsdfDescription& bsdf) {
    TextureDescription texture;
    texture.where = reader.where();
    const bool repeats = reader.boolean("repeat", true);
    texture.wrap = repeats ? TextureDescription::Wrap::Repeat : TextureDescription::Wrap::Clamp;
    texture.nearest = reader.choice("filter", "bilinear", {"bilinear", "nearest"}) == "nearest";
    texture.uvTransform = readUvTransform(reader);
    const bool isRaw = reader.boolean("raw", false);
    bsdf.reflectance = reader.color("tint", 1.0, kUnitInterval);
    const std::filesystem::path file = reader.file("filename");
    reader.finish();
    texture.bitmap = readTextureBitmap(context, file, reader.whereOf("filename"), isRaw);
    bsdf.texture = context.scene.textures.size();
    context.scene.textures.push_back(std::move(texture));
}

BsdfDescription readSurface(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    BsdfDescription bsdf;
    bsdf.where = reader.where();
    if (reader.type() == "diffuse")
        bsdf.reflectance = reader.color("albedo", 0.5, kUnitInterval);
    else if (reader.type() == "textured_diffuse")
        readTexture(context, reader, bsdf);
    else if (reader.type() == "null")
        bsdf.type = BsdfDescription::Type::Null;
    else
        reader.rejectType({"diffuse", "textured_diffuse", "null"});
    reader.finish();
    return bsdf;
}

void readLight(const ReadContext& context, const XmlElement& element, ShapeDescription& shape) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "area") reader.rejectType({"area"});
    shape.radiance = reader.color("radiance", 1.0, kNonNegative);
    shape.emitsOnBothSides = reader.boolean("twoSided", true);
    reader.finish();
}

/// A mesh without a surface bounds its medium, or is diffuse.
void readContent(ReadContext& context, PropertyReader& reader, ShapeDescription& shape) {
    shape.bsdf.where = reader.where();
    const auto medium = reader.onlyNested("medium");
    if (medium) shape.interior = readNoriMedium(context, *medium->element);
    if (const auto emitter = reader.onlyNested("emitter")) readLight(context, *emitter->element, shape);
    if (const auto bsdf = reader.onlyNested("bsdf"))
        shape.bsdf = readSurface(context, *bsdf->element);
    else if (medium)
        shape.bsdf.type = BsdfDescription::Type::Null;
    if (shape.bsdf.type == BsdfDescription::Type::Null && shape.radiance)
        reader.fail(reader.where(), "a mesh that light passes through cannot emit; give it a \"diffuse\" BSDF");
}

void readGeometry(ReadContext& context, PropertyReader& reader, ShapeDescription& shape) {
    shape.toWorld = reader.transform("toWorld").matrix;
    if (reader.type() == "obj") {
        shape.type = ShapeDescription::Type::Mesh;
        ObjOptions options;
        options.smooth = options.flipTexCoords = false;
        const std::filesystem::path file = reader.file("filename");
        shape.mesh = readObjMesh(file, reader.whereOf("filename"), options);
        context.note(shape.mesh.notes);
    } else if (reader.type() == "sphere") {
        shape.type = ShapeDescription::Type::Sphere;
        shape.center = reader.triple("center", glm::dvec3(0.0));
        shape.radius = reader.number("radius", 1.0, kPositive);
        if (!similarityOf(shape.toWorld).holds)
            reader.fail(reader.whereOf("toWorld"), "\"toWorld\" of a sphere must scale all axes alike and not shear");
    } else if (reader.type() == "rectangle") {
        shape.type = ShapeDescription::Type::Rectangle;
    } else if (reader.type() == "cube") {
        shape.type = ShapeDescription::Type::Cube;
    } else {
        reader.rejectType({"obj", "sphere", "rectangle", "cube"});
    }
}

}  // namespace

void readNoriMesh(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    ShapeDescription shape;
    shape.where = reader.where();
    readGeometry(context, reader, shape);
    readContent(context, reader, shape);
    reader.finish();
    context.scene.shapes.push_back(std::move(shape));
}

}  // namespace parhelion
