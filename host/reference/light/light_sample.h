#pragma once

#include "reference/core/scene.h"

namespace parhelion::reference {

/// A direction towards a light.
template <typename Real>
struct LightSample {
    Vec3<Real> direction;        ///< unit, away from the vertex
    Real distance;               ///< to the light point; infinite for directional lights and the environment
    std::uint32_t target;        ///< primitive of the light point, or kNone
    Vec3<Real> radianceOverPdf;  ///< selection included
    Real pdf;                    ///< per steradian, selection included; of no meaning for a delta light
    bool isDelta;
};

}  // namespace parhelion::reference
