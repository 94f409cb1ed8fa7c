#include "scene/read_film.h"

#include <algorithm>

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
        film.filter = ReconstructionFilter::Gaussian;
        film.filterStddev = reader.number("stddev", 0.5, kFilterWidth);
        film.filterRadius = 4.0 * film.filterStddev;
    } else {
        reader.rejectType({"box", "tent", "gaussian"});
    }
    reader.finish();
}

void readCrop(PropertyReader& reader, FilmDescription& film) {
    const std::vector<std::string> names{"crop_offset_x", "crop_offset_y", "crop_width", "crop_height"};
    const bool given = std::ranges::any_of(names, [&reader](const std::string& name) { return reader.has(name); });
    glm::uvec2 offset, size;
    for (int axis = 0; axis < 2; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        const std::int64_t whole = film.size[axis];
        offset[axis] = static_cast<unsigned>(reader.integer(names[i], 0, 0, whole - 1));
        size[axis] = static_cast<unsigned>(reader.integer(names[i + 2], whole, 1, whole));
        if (offset[axis] + size[axis] > film.size[axis])
            reader.fail(reader.whereOf(reader.has(names[i]) ? names[i] : names[i + 2]),
                        fmt::format("the crop must lie inside the film: {} + {} must be at most {}; got {} + {}",
                                    names[i], names[i + 2], whole, offset[axis], size[axis]));
    }
    if (!given) return;
    film.cropOffset = offset;
    film.cropSize = size;
}

/// Whether the filter reaches beyond the film.
bool readBorder(ReadContext& context, PropertyReader& reader) {
    constexpr const char* kOldName = "high_quality_edges";  // Mitsuba 2
    if (reader.has(kOldName) && reader.has("sample_border"))
        reader.fail(reader.whereOf(kOldName), "give either \"sample_border\" or its older name, not both");
    if (reader.has(kOldName))
        context.note(reader.whereOf(kOldName), fmt::format("\"{}\" was read as \"sample_border\"", kOldName));
    return reader.boolean("sample_border", reader.boolean(kOldName, false));
}

}  // namespace

void readFilm(ReadContext& context, const XmlElement& element) {
    PropertyReader reader(context.tree, element);
    if (reader.type() != "hdrfilm") reader.rejectType({"hdrfilm"});
    FilmDescription& film = context.scene.film;
    film.size.x = static_cast<unsigned>(reader.integer("width", film.size.x, 1, kLargestFilm));
    film.size.y = static_cast<unsigned>(reader.integer("height", film.size.y, 1, kLargestFilm));
    readCrop(reader, film);
    if (const auto filter = reader.onlyNested("rfilter")) readFilter(context, *filter->element);

    const std::string file = reader.choiceInAnyCase("file_format", "openexr", {"openexr", "exr", "rgbe", "pfm"});
    if (file == "rgbe" || file == "pfm")
        context.note(reader.whereOf("file_format"), fmt::format("\"file_format\" {}: openexr is written", file));
    const std::string pixels =
        reader.choiceInAnyCase("pixel_format", "rgb", {"rgb", "rgba", "luminance", "luminance_alpha", "xyz", "xyza"});
    if (pixels != "rgb")
        context.note(reader.whereOf("pixel_format"), fmt::format("\"pixel_format\" {}: rgb is written", pixels));
    const std::string components =
        reader.choiceInAnyCase("component_format", "float16", {"float16", "float32", "uint32"});
    if (components != "float32" && reader.has("component_format"))
        context.note(reader.whereOf("component_format"),
                     fmt::format("\"component_format\" {}: float32 is written", components));
    film.samplesBorder = readBorder(context, reader);
    if (reader.boolean("compensate", false))
        context.note(reader.whereOf("compensate"), "\"compensate\" has no effect: sums are always compensated");
    if (reader.accept("banner")) context.note(reader.whereOf("banner"), "\"banner\" has no effect");
    reader.finish();
}

}  // namespace parhelion
