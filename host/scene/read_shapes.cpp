#include "scene/read_shapes.h"

#include "scene/obj_mesh.h"
#include "scene/read_bsdf.h"
#include "scene/read_emitters.h"
#include "scene/read_media.h"
#include "scene/transforms.h"

namespace parhelion {
namespace {

void readObj(ReadContext& context, PropertyReader& reader, ShapeDescription& shape) {
    shape.type = ShapeDescription::Type::Mesh;
    shape.faceNormals = reader.boolean("face_normals", false);
    ObjOptions options;
    options.faceNormals = shape.faceNormals;
    options.flipTexCoords = reader.boolean("flip_tex_coords", true);
    options.toWorld = shape.toWorld;
    const std::filesystem::path file = reader.file("filename");
    shape.mesh = readObjMesh(file, reader.whereOf("filename"), options);
    context.note(shape.mesh.notes);
}

void readSphere(PropertyReader& reader, ShapeDescription& shape) {
    shape.type = ShapeDescription::Type::Sphere;
    shape.center = reader.triple("center", glm::dvec3(0.0));
    shape.radius = reader.number("radius", 1.0, kPositive);
    if (!similarityOf(shape.toWorld).holds)
        reader.fail(reader.whereOf("to_world"), "\"to_world\" of a sphere must scale all axes alike and not shear");
}

/// Accepts what changes no picture: normals of the faces where there are no others, and a weight of Mitsuba's
/// derivatives.
void readWithoutEffect(ReadContext& context, PropertyReader& reader) {
    const bool isFlat = reader.type() == "rectangle" || reader.type() == "cube";
    if (isFlat && reader.has("face_normals")) {
        reader.boolean("face_normals", false);
        context.note(reader.whereOf("face_normals"), "\"face_normals\" has no effect: the faces are flat anyway");
    }
    reader.number("silhouette_sampling_weight", 1.0);
    if (reader.has("silhouette_sampling_weight"))
        context.note(reader.whereOf("silhouette_sampling_weight"),
                     "\"silhouette_sampling_weight\" has no effect: it only steers Mitsuba's derivatives");
}

void readGeometry(ReadContext& context, PropertyReader& reader, ShapeDescription& shape) {
    shape.toWorld = reader.transform("to_world").matrix;
    shape.flipNormals = reader.boolean("flip_normals", false);
    if (reader.type() == "obj")
        readObj(context, reader, shape);
    else if (reader.type() == "sphere")
        readSphere(reader, shape);
    else if (reader.type() == "rectangle")
        shape.type = ShapeDescription::Type::Rectangle;
    else if (reader.type() == "cube")
        shape.type = ShapeDescription::Type::Cube;
    else
        reader.rejectType({"obj", "rectangle", "cube", "sphere"});
    readWithoutEffect(context, reader);
}

void readMedia(ReadContext& context, PropertyReader& reader, ShapeDescription& shape) {
    for (const PropertyReader::Nested& medium : reader.nested("medium")) {
        if (medium.name != "interior" && medium.name != "exterior")
            reader.fail(medium.where,
                        fmt::format("a medium needs name=\"interior\" or \"exterior\"; got \"{}\"", medium.name));
        const std::size_t index = mediumIndex(context, *medium.element);
        (medium.name == "interior" ? shape.interior : shape.exterior) = index;
    }
}

void readSurface(ReadContext& context, PropertyReader& reader, ShapeDescription& shape) {
    if (const auto emitter = reader.onlyNested("emitter")) readAreaEmitter(context, *emitter->element, shape);
    shape.bsdf.where = reader.where();
    if (const auto bsdf = reader.onlyNested("bsdf"))
        shape.bsdf = readBsdf(context, *bsdf->element);
    else if (shape.radiance)
        shape.bsdf.reflectance = glm::dvec3(0.0);  // as Mitsuba: a light without a BSDF is black
    if (shape.bsdf.type == BsdfDescription::Type::Null && shape.radiance)
        reader.fail(reader.where(), "an area emitter on a \"null\" BSDF is not supported; use a \"diffuse\" one");
}

}  // namespace

void readShape(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    ShapeDescription shape;
    shape.id = reader.id();
    shape.where = reader.where();
    readGeometry(context, reader, shape);
    readMedia(context, reader, shape);
    readSurface(context, reader, shape);
    reader.finish();
    context.scene.shapes.push_back(std::move(shape));
}

}  // namespace parhelion
