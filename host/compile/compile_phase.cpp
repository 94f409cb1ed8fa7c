#include "compile/compile_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "compile/distribution_table.h"

namespace parhelion {

namespace {

using Type = PhaseDescription::Type;

constexpr float kLargestG = 1.0f - 0x1p-20f;  // H1

float limitG(double g, const std::string& subject, CompiledScene& scene) {
    const float limited = std::clamp(float(g), -kLargestG, kLargestG);
    if (std::abs(g) > double(kLargestG))
        scene.notes.push_back(
            fmt::format("{}: g = {} was limited to {} (1 - 2^-20), the largest that single precision "
                        "resolves",
                        subject, g, limited));
    return limited;
}

void writeSingleLobe(double g, const std::string& subject, shared::Medium& record, CompiledScene& scene) {
    if (g == 0.0) return;
    record.phase = shared::kPhaseHenyeyGreenstein;
    record.g = limitG(g, subject, scene);
}

/// The weight becomes a multiple of 2^-24: what 24 random bits decide with exactly that probability, and then 1 -
/// weight is exact too.
void writeDualLobe(const PhaseDescription& phase, const std::string& subject, shared::Medium& record,
                   CompiledScene& scene) {
    const double weight = std::nearbyint(phase.lobeWeight * 0x1p24) * 0x1p-24;
    if (weight == 0.0 || weight == 1.0 || phase.g == phase.g2) {
        writeSingleLobe(weight == 0.0 ? phase.g2 : phase.g, subject, record, scene);
        return;
    }
    record.phase = shared::kPhaseDualHenyeyGreenstein;
    record.g = limitG(phase.g, subject, scene);
    record.g2 = limitG(phase.g2, subject, scene);
    record.lobeWeight = float(weight);
}

void checkTable(const PhaseDescription& phase, const std::string& subject) {
    const std::vector<double>& table = phase.table;
    if (table.size() < 2 || table.size() > PhaseDescription::kMostTableValues)
        throw InputError(phase.where, fmt::format("{}: a tabulated phase function must have 2 to {} values; got {}",
                                                  subject, PhaseDescription::kMostTableValues, table.size()));
    for (std::size_t i = 0; i < table.size(); ++i)
        if (!(table[i] >= 0.0 && std::isfinite(table[i])))
            throw InputError(phase.where,
                             fmt::format("{}: value {} of a tabulated phase function must be finite and >= 0; got {}",
                                         subject, i, table[i]));
    if (std::ranges::all_of(table, [](double value) { return value == 0.0; }))
        throw InputError(phase.where,
                         fmt::format("{}: a tabulated phase function must not be zero everywhere", subject));
}

/// Values per steradian, scaled so that the trapezoidal rule, exact for what goes linearly between them, gives 1.
std::vector<float> normalise(std::span<const double> table) {
    const double largest = *std::ranges::max_element(table);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < table.size(); ++i) sum += (table[i] / largest + table[i + 1] / largest) / 2.0;
    const double integral = 2.0 * std::numbers::pi * sum * 2.0 / double(table.size() - 1);
    std::vector<float> density;
    for (const double value : table) {
        const auto scaled = float(value / largest / integral);
        // A device may flush what is smaller.
        density.push_back(scaled < std::numeric_limits<float>::min() ? 0.0f : scaled);
    }
    return density;
}

void writeTable(const PhaseDescription& phase, const std::string& subject, shared::Medium& record,
                CompiledScene& scene) {
    checkTable(phase, subject);
    if (std::ranges::all_of(phase.table, [&](double value) { return value == phase.table.front(); })) return;
    const std::vector<float> density = normalise(phase.table);
    std::vector<double> weights;  // of the stored values: sampled is what evaluation gives
    for (std::size_t i = 0; i + 1 < density.size(); ++i) weights.push_back(double(density[i]) + density[i + 1]);
    const DistributionTable intervals = buildDistribution(weights);
    record.phase = shared::kPhaseTabulated;
    record.phaseOffset = std::uint32_t(scene.phaseTable.size());
    record.phaseCount = std::uint32_t(weights.size());
    scene.phaseTable.insert(scene.phaseTable.end(), density.begin(), density.end());
    record.phaseDistribution = std::uint32_t(scene.distributions.size());
    scene.distributions.insert(scene.distributions.end(), intervals.texels.begin(), intervals.texels.end());
}

}  // namespace

void compilePhase(const PhaseDescription& phase, const std::string& subject, shared::Medium& record,
                  CompiledScene& scene) {
    record.phase = shared::kPhaseIsotropic;
    if (phase.type == Type::HenyeyGreenstein) writeSingleLobe(phase.g, subject, record, scene);
    if (phase.type == Type::DualHenyeyGreenstein) writeDualLobe(phase, subject, record, scene);
    if (phase.type == Type::Rayleigh) record.phase = shared::kPhaseRayleigh;
    if (phase.type == Type::Tabulated) writeTable(phase, subject, record, scene);
}

}  // namespace parhelion
