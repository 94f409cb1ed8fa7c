// Multiple importance sampling weights.
#ifndef SAMPLING_MIS_GLSL
#define SAMPLING_MIS_GLSL

// Weight of a sample drawn with density pdfA that pdfB could also have produced (Veach 1997,
// balance heuristic), through the ratio: 0 when pdfA is 0, finite for any finite or infinite
// densities (H69, H70).
float balanceHeuristic(float pdfA, float pdfB) {
    return pdfA > 0.0 ? (isinf(pdfA) ? 1.0 : 1.0 / (1.0 + pdfB / pdfA)) : 0.0;
}

// Weight of light that scattering met, which light sampling finds with density lightPdf, both times their
// numbers of samples: all of it where light sampling never does, even if scattering takes no samples.
float emissionWeight(float scatterPdf, float lightPdf) {
    return lightPdf > 0.0 ? balanceHeuristic(scatterPdf, lightPdf) : 1.0;
}

#endif
