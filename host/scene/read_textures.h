#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// A property that is a colour, or a texture that `color` (then 1) tints.
struct TexturedColor {
    glm::dvec3 color;
    std::optional<std::size_t> texture;  ///< index into the scene's textures
};

/// Reads a colour as PropertyReader::color does, or a nested or referenced texture of that name.
TexturedColor readTexturedColor(ReadContext& context, PropertyReader& reader, std::string_view name, double fallback,
                                const NumberRange& range, ColorRole role = ColorRole::Value);

/// Index of a <texture>, which is read when it is first met: bitmap or checkerboard, as in Mitsuba.
/// @throws InputError for other plugins, and whatever is wrong with properties or file.
std::size_t textureIndex(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
