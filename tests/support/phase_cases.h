#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "reference/core/scene.h"
#include "scene/scene_description.h"
#include "support/goodness.h"

namespace parhelion::test {

/// A phase function with a compiled scene that holds it alone, and what is known of it from its description.
class PhaseCase {
public:
    PhaseCase(std::string name, const PhaseDescription& phase);

    const std::string& name() const { return name_; }
    const shared::Medium& record() const { return scene_.constants.media[0]; }
    const CompiledScene& scene() const { return scene_; }
    /// What the reference scatters by; refers to this object.
    template <typename Real>
    reference::Medium<Real> medium() const {
        return reference::viewMedium<Real>(scene_, record());
    }

    /// Probability of a cosine below mu, from 1 - mu, which is known better at a forward peak. Closed forms.
    double cdf(double oneMinusMu) const;
    /// Density per steradian at mu. Textbook forms.
    double density(double mu) const;
    /// E[P_l(mu)]: powers of g, the Rayleigh function's 1, 0, 1/10, 0, ..., quadrature that is exact for a table.
    double legendreMoment(unsigned l) const;

private:
    /// Integral of the table up to t, counted in intervals from mu = -1.
    double integralTo(double t) const;

    std::string name_;
    PhaseDescription phase_;
    CompiledScene scene_;
    std::vector<double> integrals_;  ///< of the table, up to each of its values; in intervals
};

PhaseDescription henyeyGreenstein(double g);
PhaseDescription dualHenyeyGreenstein(double g, double g2, double weight);
PhaseDescription rayleigh();
PhaseDescription tabulated(std::vector<double> values);

/// A table of `count` values with a forward peak and a glory, as of cloud droplets.
PhaseDescription dropletTable(std::size_t count);

/// Dual functions with weights and lobes at their limits, the Rayleigh function, and tables: of one interval, with
/// empty intervals, with a single peak inside and at either end, and of droplets.
std::vector<PhaseCase> newPhaseCases();

using PhaseSampler = std::function<glm::vec3(const glm::vec3& wo, const glm::vec2& u, std::uint32_t choice)>;
/// samplePhase.
PhaseSampler samplerOf(const PhaseCase& phase);

/// Cell of a deflection by 1 - mu and the share of the full turn.
using DeflectionCell = std::function<std::size_t(double oneMinusMu, double turn)>;

/// Scatters a skew ray.
/// @param share  of the samples that a distortion of half a percent needs; seeded defects are larger.
CellTest scatterInto(CellTest cells, const DeflectionCell& cellOf, const PhaseSampler& sampler, double share = 1);

/// Into 6 x 3 cells of equal probability by distribution function and azimuth about the direction of travel.
CellTest scatterIntoEqualCells(const PhaseCase& phase, const PhaseSampler& sampler, double significance,
                               double share = 1);

}  // namespace parhelion::test
