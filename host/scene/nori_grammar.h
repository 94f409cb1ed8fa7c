#pragma once

#include "scene/xml_document.h"

namespace parhelion {

/// Whether a document is a scene in Nori's dialect: its root is <test>, or <scene> without a version around a <camera>
/// or a <mesh>, which Mitsuba's dialect has not.
bool isNoriScene(const XmlElement& root);

/// Checks tags, nesting and attributes, and gives every name the one form that the readers of the parts ask for:
/// property names become camelCase ("sigma_a" is sigmaA), and a rotation's `axis` becomes the `value` that Mitsuba's
/// dialect has in its place.
/// @throws InputError with the nearest name and what is allowed; for a <test>, which is no scene; and for vectors that
/// are not three numbers.
void prepareNoriScene(XmlElement& root);

}  // namespace parhelion
