#pragma once

#include <vector>

namespace parhelion {

/// Exponent of the density of a distribution's upper tail, from the largest values: p(x) ~ x^-slope. At most 10, which
/// also stands for a tail that ends; at 3 and below the variance is infinite. Values <= 0 say nothing.
/// @param values  at least 500 that are positive are needed: 10 for fewer.
/// Source: Hill 1975, "A Simple General Approach to Inference About the Tail of a Distribution"; from the largest 201,
/// or 5 % where those are fewer, as MCNP and Geant4 do.
double tailSlope(std::vector<double> values);

}  // namespace parhelion
