#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "scene/xml_document.h"

namespace parhelion {

/// The attribute's value as one type. Spaces around it are ignored; anything else is an error.
/// @throws InputError at the value: not of that type, or not finite.
double parseNumber(const XmlAttribute& attribute);
std::int64_t parseInteger(const XmlAttribute& attribute);
bool parseBoolean(const XmlAttribute& attribute);

/// Numbers separated by commas, spaces or both.
std::vector<double> parseNumbers(const XmlAttribute& attribute);

/// Three numbers.
glm::dvec3 parseTriple(const XmlAttribute& attribute);

/// Linear Rec. 709: "r, g, b", one number for grey, or "#rrggbb" (sRGB encoded, decoded here).
glm::dvec3 parseColor(const XmlAttribute& attribute);

/// x, y, z of a <point>, <vector>, <translate>, <scale> or <rotate>: from `value` (one number for all three, or
/// three) or from x, y and z, those left out being `fallback`; without a fallback none may be left out.
/// @throws InputError also when both forms are mixed.
glm::dvec3 parseXyz(const XmlElement& element, std::optional<double> fallback);

/// The number that `text` is, spaces around it aside; NaN when it is anything else or beyond a double. What is too
/// small for one is 0.
double numberOrNan(std::string_view text);

}  // namespace parhelion
