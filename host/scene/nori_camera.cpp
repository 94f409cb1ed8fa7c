#include "scene/nori_camera.h"

#include "scene/read_film.h"
#include "scene/read_sensor.h"

namespace parhelion {
namespace {

void readFilter(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    FilmDescription& film = context.scene.film;
    if (reader.type() == "box") {
        film.filter = ReconstructionFilter::Box;
        film.filterRadius = 0.5;
    } else if (reader.type() == "tent") {
        film.filter = ReconstructionFilter::Tent;
        film.filterRadius = reader.number("radius", 1.0, kFilterWidth);
    } else if (reader.type() == "gaussian") {
        film.filterRadius = reader.number("radius", 2.0, kFilterWidth);
        film.filterStddev = reader.number("stddev", 0.5, kFilterWidth);
    } else {
        reader.rejectType({"gaussian", "box", "tent"});
    }
    reader.finish();
}

}  // namespace

void readNoriCamera(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "perspective") reader.rejectType({"perspective"});
    FilmDescription& film = context.scene.film;
    film.size.x = static_cast<unsigned>(reader.integer("width", 1280, 1, kLargestFilm));
    film.size.y = static_cast<unsigned>(reader.integer("height", 720, 1, kLargestFilm));
    if (const auto filter = reader.onlyNested("rfilter")) readFilter(context, *filter->element);

    CameraDescription& camera = context.scene.camera;
    camera.where = reader.where();
    camera.fovDegrees = reader.number("fov", 30.0, kFovRange);
    camera.toWorld = readCameraTransform(reader, "toWorld");
    readClipping(context, reader, "nearClip", "farClip");
    reader.finish();
}

void readNoriSampler(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "independent") reader.rejectType({"independent"});
    context.scene.sampleCount = static_cast<std::uint64_t>(reader.integer("sampleCount", 1, 1, kMostSamples));
    context.scene.seed = static_cast<std::uint32_t>(reader.integer("seed", 0, 0, 0xffffffffLL));
    reader.finish();
}

}  // namespace parhelion
