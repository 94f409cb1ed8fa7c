#include "scene/read_bitmaps.h"

namespace parhelion {
namespace {

Bitmap readWithNotes(ReadContext& context, const std::filesystem::path& file, const SourceLocation& where,
                     BitmapEncoding encoding) {
    Bitmap bitmap = readBitmap(file, where, encoding);
    context.scene.notes.insert(context.scene.notes.end(), bitmap.notes.begin(), bitmap.notes.end());
    return bitmap;
}

/// Whether a map has the proportions of a cube's six faces: in a row, a column or a cross.
bool looksLikeCube(const glm::uvec2& size) {
    const auto isOf = [&size](unsigned columns, unsigned rows) {
        constexpr unsigned kLeast = 8;  // texels a face; smaller maps are made by hand
        return size.x % columns == 0 && size.x / columns >= kLeast && size.x / columns * rows == size.y;
    };
    return isOf(1, 6) || isOf(6, 1) || isOf(4, 3) || isOf(3, 4);
}

}  // namespace

Bitmap readTextureBitmap(ReadContext& context, const std::filesystem::path& file, const SourceLocation& where,
                         bool isRaw) {
    return readWithNotes(context, file, where, isRaw ? BitmapEncoding::kRaw : BitmapEncoding::kSrgb);
}

Bitmap readEnvironmentBitmap(ReadContext& context, const std::filesystem::path& file, const SourceLocation& where) {
    Bitmap bitmap = readWithNotes(context, file, where, BitmapEncoding::kSrgb);
    const std::string& layout = bitmap.environmentLayout;
    if (!layout.empty() && layout != "latitude-longitude")
        throw InputError(where,
                         fmt::format("an environment map must be laid out by latitude and longitude; the attribute "
                                     "\"envmap\" of '{}' says: {}",
                                     file.string(), layout == "cube" ? "cube map" : "an unknown layout"));
    if (layout.empty() && looksLikeCube(bitmap.size))
        context.note(where,
                     fmt::format("a map of {} x {} texels has the shape of the faces of a cube; it is taken for one "
                                 "of latitude and longitude",
                                 bitmap.size.x, bitmap.size.y));
    return bitmap;
}

}  // namespace parhelion
