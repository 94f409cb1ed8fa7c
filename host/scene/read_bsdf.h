#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads a <bsdf>: diffuse, null, or twosided around a diffuse one.
BsdfDescription readBsdf(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
