#pragma once

#include "scene/read_context.h"

namespace parhelion {

/// Reads the <camera>, which holds the film's size and its reconstruction filter as well.
void readNoriCamera(ReadContext& context, const XmlElement& element);

/// Reads the <sampler>: the number of samples a pixel.
void readNoriSampler(ReadContext& context, const XmlElement& element);

}  // namespace parhelion
