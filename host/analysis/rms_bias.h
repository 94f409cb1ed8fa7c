#pragma once

#include "analysis/agreement.h"

namespace parhelion {

/// The k-th images of both sides are paired; the longer side's rest is left out.
/// @return nothing for fewer than three pairs, which a jackknife needs.
std::optional<RmsBias> rmsBias(std::span<const Image> a, std::span<const Image> b, const std::string& channel,
                               double confidence);

}  // namespace parhelion
