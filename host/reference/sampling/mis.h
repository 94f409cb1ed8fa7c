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

/// Weight of light met by scattering that light sampling finds with density lightPdf; 1 where it never does.
///
/// @param scatterPdf, lightPdf  each times the samples its strategy counts for.
template <typename Real>
Real emissionWeight(Real scatterPdf, Real lightPdf) {
    if (lightPdf == 0) return 1;
    return balanceHeuristic(scatterPdf, lightPdf);
}

}  // namespace parhelion::reference
