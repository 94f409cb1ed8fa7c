#pragma once

#include <type_traits>

#include "reference/core/math.h"
#include "reference/path_trace.h"

namespace parhelion::reference {

/// Adds to a sum kept as high + low: compensated in float, exact to double otherwise (H77).
///
/// Source: Kahan 1965, "Further Remarks on Reducing Truncation Errors".
template <typename Real>
void addCompensated(float& high, float& low, Real value) {
    if constexpr (std::is_same_v<Real, float>) {
        const float y = value + low;
        const float sum = high + y;
        low = y - (sum - high);
        high = sum;
    } else {
        const Real sum = Real(high) + Real(low) + value;
        high = float(sum);
        low = float(sum - Real(high));
    }
}

/// Whether a sample and its square stay within float, in which films are kept: false for what is no number.
template <typename Real>
bool fitsFilm(const Vec3<Real>& radiance) {
    for (int c = 0; c < 3; ++c)
        if (!(std::abs(radiance[c]) < Real(shared::kLargestSample))) return false;
    return true;
}

/// Rec. 709.
template <typename Real>
Real luminance(const Vec3<Real>& radiance) {
    return Real(0.2126f) * radiance.x + Real(0.7152f) * radiance.y + Real(0.0722f) * radiance.z;
}

/// Adds one sample to a pixel. A sample that does not fit counts as zero; it and negative ones are counted.
/// @param first  whether the pixel is empty.
template <typename Real>
void accumulate(shared::FilmPixel& pixel, Vec3<Real> radiance, bool first, Counters& counters) {
    if (!fitsFilm(radiance)) {
        ++counters[shared::kCounterNonFinite];
        radiance = Vec3<Real>(0);
    }
    if (radiance.x < 0 || radiance.y < 0 || radiance.z < 0) ++counters[shared::kCounterNegative];
    for (int c = 0; c < 3; ++c) {
        addCompensated(pixel.sumHigh[c], pixel.sumLow[c], radiance[c]);
        addCompensated(pixel.squareHigh[c], pixel.squareLow[c], radiance[c] * radiance[c]);
    }
    const Real y = luminance(radiance);
    if (first) pixel.pivot = float(y);
    const Real d = y - Real(pixel.pivot);
    const Real square = d * d;
    addCompensated(pixel.powerHigh.x, pixel.powerLow.x, d);
    addCompensated(pixel.powerHigh.y, pixel.powerLow.y, square);
    pixel.third += float(square * d);
    pixel.fourth += float(square * square);
    pixel.largest = std::max(pixel.largest, float(y));
}

}  // namespace parhelion::reference
