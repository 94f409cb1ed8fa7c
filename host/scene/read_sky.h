#pragma once

#include "scene/property_reader.h"
#include "scene/scene_description.h"

namespace parhelion {

/// What a dialect calls the parameters of a sky.
struct SkyNames {
    const char *axis, *offset, *width, *power, *bottom, *top;
    const char *starDensity, *starSize, *starRadiance, *starSeed;
};

/// Reads a gradient sky with its stars. Both dialects read it here, so that they share every limit: at most kMaxStars
/// stars on average, on at most a tenth of the sky, for whose places scatterStars needs few attempts.
///
/// @throws InputError at the value if one is out of range.
SkyDescription readSky(PropertyReader& reader, const SkyNames& names, ColorRole role);

}  // namespace parhelion
