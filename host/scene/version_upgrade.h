#pragma once

#include "scene/xml_document.h"

namespace parhelion {

/// Rewrites a file's tree, root included, to today's names if the root's version is below 2: camelCase property
/// names become snake_case, <lookAt> becomes <lookat>, diffuse_reflectance becomes reflectance; uoffset, voffset,
/// uscale and vscale of a texture become its to_uv. A root that is no <scene> need not have a version.
/// @throws InputError for a version that is malformed or above 3.
void upgradeVersion(XmlElement& root);

}  // namespace parhelion
