#pragma once

#include "support/rendering.h"

namespace parhelion::test {

/// A medium that absorbs nothing, in a uniform sky of radiance 1: every pixel is 1.
struct Furnace {
    double tau = 1;  ///< optical thickness: of the sphere's diameter, or of the grid's cube on average
    double g = 0;
    bool isGrid = false;     ///< a cube whose density varies between 0 and 1; otherwise a homogeneous sphere
    bool sampleSky = false;  ///< next-event estimation of the sky, which scattering alone would find without variance
    unsigned size = 8;       ///< pixels along each edge; all of them see the medium
    double red = 1;          ///< share of the sphere's extinction that red light meets
};

CompiledScene furnaceScene(const Furnace& furnace);
std::string name(const Furnace& furnace);

/// Fails unless every pixel is 1 within 1e-4 after 256 samples, and nothing was counted as an anomaly.
void expectWhite(Backend backend, const Furnace& furnace);

/// Fails unless the mean of red is 1 by a z-test (1e-6), and unless that test finds a bias of the given size with 99 %
/// power.
void expectWhiteOnAverage(Backend backend, const Furnace& furnace, std::uint64_t samples, double bias = 0.001);

}  // namespace parhelion::test
