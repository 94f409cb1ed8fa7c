#pragma once

#include "scene/xml_document.h"

namespace parhelion {

/// Whether elements with this tag are objects, in either dialect: they have a plugin type, properties and nested
/// objects.
bool isObjectTag(std::string_view tag);

/// Whether elements with this tag hold one named value, in either dialect (float, rgb, color, transform, ...).
bool isPropertyTag(std::string_view tag);

/// Checks that the element's tag exists, may stand inside `parent` (empty: the top of a file), and has the attributes
/// it needs and no others.
/// @throws InputError with the nearest name and what is allowed.
void checkElement(const XmlElement& element, std::string_view parent);

}  // namespace parhelion
