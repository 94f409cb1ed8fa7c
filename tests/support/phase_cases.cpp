#include "support/phase_cases.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "compile/compile_phase.h"
#include "reference/volume/phase_function.h"
#include "support/words.h"

namespace parhelion::test {
namespace {

using Type = PhaseDescription::Type;

/// (1 - g^2) / 2g (1 / s - 1 / (1 + g)) with s^2 = 1 + g^2 - 2 g mu, its pole at g = 0 divided out.
double henyeyGreensteinCdf(double g, double oneMinusMu) {
    const double s = std::sqrt((1 - g) * (1 - g) + 2 * g * oneMinusMu);
    return (1 - g) * (2 - oneMinusMu) / (s * (1 + g + s));
}

double henyeyGreensteinDensity(double g, double mu) {
    const double square = 1 + g * g - 2 * g * mu;
    return (1 - g * g) / (4 * std::numbers::pi * square * std::sqrt(square));
}

double intervalsOf(const std::vector<double>& table) { return double(table.size() - 1); }

}  // namespace

PhaseCase::PhaseCase(std::string name, const PhaseDescription& phase) : name_(std::move(name)), phase_(phase) {
    shared::Medium& medium = scene_.constants.media[0];
    compilePhase(phase, name_, medium, scene_);
    medium.flags = shared::kMediumHomogeneous;
    medium.sigmaMax = 1;
    medium.sigmaRatio = medium.albedo = glm::vec3(1);
    scene_.constants.mediumCount = 1;
    integrals_.push_back(0);
    for (std::size_t i = 0; i + 1 < phase.table.size(); ++i)
        integrals_.push_back(integrals_.back() + (phase.table[i] + phase.table[i + 1]) / 2);
    // What the compiler rounds (g, the weight) is part of the question, not of the answer.
    if (phase.type != Type::Tabulated) phase_.g = medium.g, phase_.g2 = medium.g2;
    if (phase.type == Type::DualHenyeyGreenstein) phase_.lobeWeight = medium.lobeWeight;
}

double PhaseCase::integralTo(double t) const {
    const std::vector<double>& table = phase_.table;
    const std::size_t i = std::min(std::size_t(std::max(t, 0.0)), table.size() - 2);
    const double part = std::clamp(t - double(i), 0.0, 1.0);
    return integrals_[i] + part * (table[i] + part * (table[i + 1] - table[i]) / 2);
}

double PhaseCase::cdf(double oneMinusMu) const {
    const double mu = 1 - oneMinusMu;
    switch (phase_.type) {
        case Type::HenyeyGreenstein:
            return henyeyGreensteinCdf(phase_.g, oneMinusMu);
        case Type::DualHenyeyGreenstein:
            return phase_.lobeWeight * henyeyGreensteinCdf(phase_.g, oneMinusMu) +
                   (1 - phase_.lobeWeight) * henyeyGreensteinCdf(phase_.g2, oneMinusMu);
        case Type::Rayleigh:
            return (4 + 3 * mu + mu * mu * mu) / 8;
        case Type::Tabulated: {
            const double intervals = intervalsOf(phase_.table), t = (1 + mu) / 2 * intervals;
            return integralTo(t) / integrals_.back();
        }
        case Type::Isotropic:
            break;
    }
    return (1 + mu) / 2;
}

double PhaseCase::density(double mu) const {
    switch (phase_.type) {
        case Type::HenyeyGreenstein:
            return henyeyGreensteinDensity(phase_.g, mu);
        case Type::DualHenyeyGreenstein:
            return phase_.lobeWeight * henyeyGreensteinDensity(phase_.g, mu) +
                   (1 - phase_.lobeWeight) * henyeyGreensteinDensity(phase_.g2, mu);
        case Type::Rayleigh:
            return 3 * (1 + mu * mu) / (16 * std::numbers::pi);
        case Type::Tabulated: {
            const std::vector<double>& table = phase_.table;
            const double intervals = intervalsOf(table), t = (1 + mu) / 2 * intervals;
            const std::size_t i = std::min(std::size_t(t), table.size() - 2);
            const double value = table[i] + (t - double(i)) * (table[i + 1] - table[i]);
            return value * intervals / (4 * std::numbers::pi * integrals_.back());
        }
        case Type::Isotropic:
            break;
    }
    return 1 / (4 * std::numbers::pi);
}

double PhaseCase::legendreMoment(unsigned l) const {
    switch (phase_.type) {
        case Type::HenyeyGreenstein:
            return std::pow(phase_.g, l);
        case Type::DualHenyeyGreenstein:
            return phase_.lobeWeight * std::pow(phase_.g, l) + (1 - phase_.lobeWeight) * std::pow(phase_.g2, l);
        case Type::Rayleigh:
            return l == 0 ? 1 : l == 2 ? 0.1 : 0;
        case Type::Tabulated: {
            double sum = 0;
            const double intervals = intervalsOf(phase_.table);
            for (double i = 0; i < intervals; ++i)
                sum += boost::math::quadrature::gauss<double, 7>::integrate(
                    [&](double mu) { return 2 * std::numbers::pi * density(mu) * std::legendre(l, mu); },
                    -1 + 2 * i / intervals, -1 + 2 * (i + 1) / intervals);
            return sum;
        }
        case Type::Isotropic:
            break;
    }
    return l == 0 ? 1 : 0;
}

PhaseDescription henyeyGreenstein(double g) {
    PhaseDescription phase;
    phase.type = Type::HenyeyGreenstein;
    phase.g = g;
    return phase;
}

PhaseDescription dualHenyeyGreenstein(double g, double g2, double weight) {
    PhaseDescription phase;
    phase.type = Type::DualHenyeyGreenstein;
    phase.g = g;
    phase.g2 = g2;
    phase.lobeWeight = weight;
    return phase;
}

PhaseDescription rayleigh() {
    PhaseDescription phase;
    phase.type = Type::Rayleigh;
    return phase;
}

PhaseDescription tabulated(std::vector<double> values) {
    PhaseDescription phase;
    phase.type = Type::Tabulated;
    phase.table = std::move(values);
    return phase;
}

PhaseDescription dropletTable(std::size_t count) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        const double mu = -1 + 2 * double(i) / double(count - 1);
        values.push_back(0.9 * henyeyGreensteinDensity(0.9, mu) + 0.1 * henyeyGreensteinDensity(-0.7, mu));
    }
    return tabulated(values);
}

std::vector<PhaseCase> newPhaseCases() {
    return {{"dual 0.7 * 0.85 + 0.3 * -0.3", dualHenyeyGreenstein(0.85, -0.3, 0.7)},
            {"dual, forward peak of weight 2^-10", dualHenyeyGreenstein(0.999, 0.1, 0x1p-10)},
            {"dual, isotropic and backward", dualHenyeyGreenstein(0, -0.99, 0.5)},
            {"Rayleigh", rayleigh()},
            {"table of one rising interval", tabulated({0, 1})},
            {"table with empty intervals", tabulated({0, 0, 2, 0, 0, 0, 1, 1})},
            {"table with all at the back", tabulated({1, 0, 0, 0})},
            {"table with all ahead", tabulated({0, 0, 0, 1e-200})},
            {"table of nearly equal values", tabulated({1, 1 + 1e-6, 1})},
            {"table of droplets", dropletTable(181)}};
}

PhaseSampler samplerOf(const PhaseCase& phase) {
    return [medium = phase.medium<float>()](const glm::vec3& wo, const glm::vec2& u, std::uint32_t choice) {
        return reference::samplePhase(medium, wo, wordsOf(u), choice).direction;
    };
}

CellTest scatterInto(CellTest cells, const DeflectionCell& cellOf, const PhaseSampler& sampler, double share) {
    const glm::vec3 wo = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
    const glm::dvec3 travel = -glm::normalize(glm::dvec3(wo));
    const glm::dvec3 side = glm::normalize(glm::cross(travel, glm::dvec3(1, 0, 0))), up = glm::cross(travel, side);
    IndependentNumbers numbers(11);
    for (auto i = std::uint64_t(share * double(cells.samplesNeeded())); i > 0; --i) {
        const glm::vec2 u = numbers.pair<float>();
        const glm::dvec3 wi(sampler(wo, u, numbers.word()));
        const glm::dvec3 chord = wi - travel;
        cells.add(cellOf(glm::dot(chord, chord) / 2, turnOf(glm::dot(wi, side), glm::dot(wi, up))));
    }
    return cells;
}

CellTest scatterIntoEqualCells(const PhaseCase& phase, const PhaseSampler& sampler, double significance, double share) {
    constexpr std::size_t kPolar = 6, kAzimuth = 3;
    const auto cellOf = [&](double oneMinusMu, double turn) {
        return partOf(phase.cdf(oneMinusMu), kPolar) * kAzimuth + partOf(turn, kAzimuth);
    };
    return scatterInto(CellTest(kPolar * kAzimuth, significance), cellOf, sampler, share);
}

}  // namespace parhelion::test
