#pragma once

#include "reference/core/math.h"

namespace parhelion::reference {

/// pdfA / (pdfA + pdfB), without overflow; an infinite pdfA gives 1, two zeros give 0.
///
/// Source: Veach and Guibas 1995, "Optimally Combining Sampling Techniques".
template <typename Real>
Real balanceHeuristic(Real pdfA, Real pdfB) {
    if (pdfA == 0) return 0;
    if (std::isinf(pdfA)) return 1;
    return 1 / (1 + pdfB / pdfA);
}

}  // namespace parhelion::reference
