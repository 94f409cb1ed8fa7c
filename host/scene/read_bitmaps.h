#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a bitmap that a scene names, and passes its notes on.
///
/// @param where  of the name; blamed for a missing file.
/// @throws InputError as readBitmap.
Bitmap readTextureBitmap(ReadContext& context, const std::filesystem::path& file, const SourceLocation& where,
                         bool isRaw);

/// As above, of a map in latitude and longitude.
/// @throws InputError as readBitmap, and at `where` for a file that says that it has another layout.
Bitmap readEnvironmentBitmap(ReadContext& context, const std::filesystem::path& file, const SourceLocation& where);

}  // namespace parhelion
