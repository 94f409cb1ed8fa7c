#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/rendering.h"

namespace parhelion::test {

/// A row of slabs.csv: a plane-parallel slab with a (dual) Henyey-Greenstein phase function, and what it does to
/// collimated light of unit flux, incident at mu = 1 or 0.5.
struct SlabRow {
    double tau = 0, albedo = 0, g = 0;
    double g2 = 0, weight = 1;                ///< weight HG(g) + (1 - weight) HG(g2)
    double reflected1 = 0, transmitted1 = 0;  ///< total, the unscattered light included
    double reflected05 = 0, transmitted05 = 0;

    std::string name() const;
    /// What is reflected if lit from above, else transmitted; mu is 1 or 0.5.
    double exact(double mu, bool litFromAbove) const;
};

/// Every row, in the table's order.
std::vector<SlabRow> readSlabRows(const std::filesystem::path& table);

/// How a slab is looked at.
struct SlabView {
    double mu = 1;              ///< cosine between the line of sight and the slab's normal
    bool litFromAbove = true;   ///< the camera's side sees the sky, a black plane covers the other; false: reverse
    double thickness = 1;       ///< scene units; the extinction is tau / thickness
    bool constantGrid = false;  ///< the slab's medium is a density grid of ones
    unsigned size = 64;         ///< pixels along each edge of the film; all have the same expectation
};

/// The slab under a uniform sky of radiance 1, by reciprocity what it reflects of (or lets through for) light that
/// comes in along the line of sight. It is 2e4 thicknesses wide: what the edge adds is below 1e-8 (light at cosines
/// below 1e-4). The film spans 0.1 degrees, which changes the mean over mu by less than 1e-6.
CompiledScene slabScene(const SlabRow& slab, const SlabView& view);

/// Samples per pixel after which a render has spent `events` scatterings and camera rays in all, at least 1.
std::uint64_t samplesFor(const CompiledScene& scene, double events);

/// z-tests of many estimates against exact values, and one of a relative bias that they have in common.
class SlabScores {
public:
    /// @param tests  how many single tests the significance of 1e-6 is split among (Sidak).
    explicit SlabScores(std::size_t tests);
    /// `exact` is known to 1e-6 (the table's 6 trusted decimals, the film's 0.1 degrees).
    void add(const PixelEstimate& found, double exact, const std::string& what);
    /// Takes an estimate for the common bias alone.
    void collect(const PixelEstimate& found, double exact);
    /// Takes the estimates of other scores for the common bias; they have been tested one by one.
    void pool(const SlabScores& other);
    /// Fails when the common bias is significant (1e-6), and when one of `resolution` would not have been found with
    /// 99 % power. Prints both.
    void expectNoCommonBias(double resolution, const std::string& what) const;
    /// Whether the common bias is significant (1e-6): for seeded defects.
    bool haveCommonBias() const;

private:
    double threshold_ = 0;
    double weightedBias_ = 0, weight_ = 0;
};

}  // namespace parhelion::test
