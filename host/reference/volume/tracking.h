#pragma once

#include <optional>

#include "compile/compiled_scene.h"
#include "reference/geometry/intersection.h"
#include "reference/path_trace.h"
#include "reference/sampling/sampler.h"
#include "reference/volume/density.h"
#include "reference/volume/majorant.h"

namespace parhelion::reference {

/// What all parts of a path share.
template <typename Real, typename Trace>
struct PathContext {
    const SceneView<Real>& scene;
    const Quality& quality;
    Stream stream;
    int hero;  ///< channel that chromatic collisions are decided by
    Counters& counters;
    Trace& trace;
};

/// The optical depth left to a ray's next tentative collision. Runs on across cells, boundaries and media, so that
/// a boundary costs neither a draw nor a logarithm.
template <typename Real>
struct Residual {
    Real depth;
    std::uint32_t index = 0;  ///< tentative collisions of this ray so far

    /// Names the draw of the collision to come. `kind`: kDrawFlight or kDrawShadow.
    /// Reference only: segmentPurpose in the shader.
    std::uint32_t purpose(std::uint32_t kind) const { return kind | index << shared::kDrawIndexShift; }

    /// Reference only: the shader keeps the two numbers in its path state.
    void spend(Real opticalDepth) { depth = std::max(Real(0), depth - opticalDepth); }

    /// Reference only: as above.
    void renew(const glm::uvec4& words) {
        depth = exponential<Real>(words.z, words.w >> 8);
        ++index;
    }
};

/// Throughput, and how much likelier each channel was than the hero to sample the path (1 for grey paths).
///
/// Source: Miller, Georgiev, Jarosz 2019, "A null-scattering path integral formulation of light transport".
template <typename Real>
struct Throughput {
    Vec3<Real> beta{1};
    Vec3<Real> r{1};

    /// Reference only: as above.
    Real meanR() const { return (r.x + r.y + r.z) / 3; }

    /// Reference only: as above.
    void scale(const Vec3<Real>& ratio) {
        beta *= ratio;
        r *= ratio;
    }
};

/// Moves to the next tentative collision, or to tEnd.
/// Reference only: a loop over cells; the shader steps one cell at a time.
///
/// @return whether there is a collision before tEnd; walk.t is where.
template <typename Real>
bool nextCollision(const Medium<Real>& medium, CellWalk<Real>& walk, Real tEnd, Residual<Real>& residual,
                   Counters& counters) {
    for (;;) {
        ++counters[shared::kCounterSteps];
        const int axis = nearestAxis(walk);
        const Real te = std::max(walk.t, std::min(walk.planes[axis], tEnd));
        const Real sigma = medium.sigmaMax * walk.bound;
        const Real opticalDepth = sigma * (te - walk.t);
        if (opticalDepth > residual.depth) {
            walk.t = std::min(walk.t + residual.depth / sigma, te);
            ++counters[shared::kCounterCollisions];
            return true;
        }
        residual.spend(opticalDepth);
        walk.t = te;
        if (te >= tEnd) return false;
        nextCell(medium, walk, axis);
    }
}

/// Density of each channel at the walk's position, checked against the bound of its cell.
/// Reference only: within stepSegment in the shader.
template <typename Real, typename Trace>
Vec3<Real> densityHere(const PathContext<Real, Trace>& path, const Medium<Real>& medium, const CellWalk<Real>& walk,
                       const glm::uvec4& words) {
    const Vec3<Real> position = walk.origin + walk.t * walk.direction;
    const Vec3<Real> offsets = cornerOffsets<Real>(words);
    const bool stochastic = path.quality.stochasticFilter;
    const Vec3<Real> density = densityAt(medium, position, offsets, stochastic);
    if (maxComponent(density) > walk.bound) ++path.counters[shared::kCounterMajorantViolations];
    return density;
}

/// Decides whether a flight's tentative collision is real.
///
/// @param u  uniform.
template <typename Real>
bool decideFlight(const Medium<Real>& medium, const Vec3<Real>& density, Real bound, Real u, int hero,
                  Throughput<Real>& throughput) {
    const bool isReal = u * bound < medium.sigmaRatio[hero] * density[hero];
    if (medium.grey) return isReal;
    const Vec3<Real> q = glm::min(Vec3<Real>(1), medium.sigmaRatio * (density / bound));
    throughput.scale(isReal ? q / q[hero] : (Real(1) - q) / (1 - q[hero]));
    return isReal;
}

/// Attenuates a shadow ray at a tentative collision, and plays roulette once it is weak.
///
/// @param q          extinction over bound, per channel.
/// @param threshold  largest weight that roulette restores survivors to, in [0, 1].
/// @return whether the ray is alive.
template <typename Real>
bool decideShadow(const Vec3<Real>& q, Real u, Real threshold, Vec3<Real>& weight) {
    weight *= glm::max(Vec3<Real>(0), Real(1) - q);
    const Real largest = maxComponent(weight);
    if (largest >= threshold) return true;
    if (!(u * threshold < largest)) return false;
    weight *= threshold / largest;
    return true;
}

/// Reference only: within stepSegment in the shader.
template <typename Real, typename Trace>
std::optional<Real> trackHomogeneousFlight(const PathContext<Real, Trace>& path, const Medium<Real>& medium, Real t,
                                           Real tEnd, std::uint32_t vertex, Residual<Real>& residual,
                                           Throughput<Real>& throughput) {
    for (;;) {
        ++path.counters[shared::kCounterSteps];
        const Real collision = t + residual.depth / medium.sigmaMax;
        if (!(collision < tEnd)) {
            residual.spend(medium.sigmaMax * (tEnd - t));
            return std::nullopt;
        }
        t = collision;
        ++path.counters[shared::kCounterCollisions];
        if (medium.grey) return t;
        const glm::uvec4 words = draw(path.stream.key, vertex, residual.purpose(shared::kDrawFlight));
        residual.renew(words);
        if (decideFlight(medium, Vec3<Real>(1), Real(1), toUniform<Real>(words.x), path.hero, throughput)) return t;
    }
}

/// Puts the walk where the segment [tMin, tEnd] enters the grid, and ends the segment where it leaves it.
/// Reference only: part of startSegment in the shader.
///
/// @return whether any of it is inside.
template <typename Real>
bool clipToGrid(const Medium<Real>& medium, Real tMin, Real& tEnd, CellWalk<Real>& walk) {
    const Vec2<Real> interval = gridInterval(medium, walk);
    const Real start = std::max(tMin, interval.x);
    tEnd = std::min(tEnd, interval.y);
    if (!(start < tEnd)) return false;
    startCell(medium, start, walk);
    return true;
}

/// Samples where a path scatters in one medium between ray.tMin and tEnd.
/// Reference only: a loop over collisions; the shader takes one at a time.
///
/// @param vertex  scatterings before.
/// @return t of the real collision, or nothing when the path reaches tEnd.
template <typename Real, typename Trace>
std::optional<Real> trackFlight(const PathContext<Real, Trace>& path, const Medium<Real>& medium, const Ray<Real>& ray,
                                Real tEnd, std::uint32_t vertex, Residual<Real>& residual,
                                Throughput<Real>& throughput) {
    if (medium.homogeneous) {
        const auto t = trackHomogeneousFlight(path, medium, ray.tMin, tEnd, vertex, residual, throughput);
        if (t) path.trace.add(PathEvent::Collision, 0);
        return t;
    }
    CellWalk<Real> walk = gridRay(medium, ray.origin, ray.direction);
    if (!clipToGrid(medium, ray.tMin, tEnd, walk)) return std::nullopt;
    while (nextCollision(medium, walk, tEnd, residual, path.counters)) {
        const glm::uvec4 words = draw(path.stream.key, vertex, residual.purpose(shared::kDrawFlight));
        const Vec3<Real> density = densityHere(path, medium, walk, words);
        const Real u = toUniform<Real>(words.x);
        if constexpr (Trace::kIsOn) {
            const double q = double(density[path.hero]) / double(walk.bound) * double(medium.sigmaRatio[path.hero]);
            path.trace.add(Decision{Decision::Kind::Flight, vertex, residual.index, walk.index, double(u), q});
        }
        residual.renew(words);
        const bool isReal = decideFlight(medium, density, walk.bound, u, path.hero, throughput);
        path.trace.add(isReal ? PathEvent::Collision : PathEvent::NullCollision, walk.index);
        if (isReal) return walk.t;
    }
    return std::nullopt;
}

/// Attenuates a shadow ray by one medium between ray.tMin and tEnd: ratio tracking that turns into delta tracking
/// as the weight falls below the threshold.
/// Reference only: a loop over collisions; the shader takes one at a time.
///
/// @param vertex     scatterings so far; chooses the draws.
/// @param threshold  see decideShadow.
/// @param weight     transmittance estimate so far, per channel.
/// @return whether the ray is alive.
template <typename Real, typename Trace>
bool trackShadow(const PathContext<Real, Trace>& path, const Medium<Real>& medium, const Ray<Real>& ray, Real tEnd,
                 std::uint32_t vertex, Real threshold, Residual<Real>& residual, Vec3<Real>& weight) {
    if (medium.homogeneous) {
        ++path.counters[shared::kCounterSteps];
        const Vec3<Real> depth = medium.sigmaMax * medium.sigmaRatio * (tEnd - ray.tMin);
        weight *= Vec3<Real>(expNegative(-depth.x), expNegative(-depth.y), expNegative(-depth.z));
        return maxComponent(weight) > 0;
    }
    CellWalk<Real> walk = gridRay(medium, ray.origin, ray.direction);
    if (!clipToGrid(medium, ray.tMin, tEnd, walk)) return true;
    while (nextCollision(medium, walk, tEnd, residual, path.counters)) {
        const glm::uvec4 words = draw(path.stream.key, vertex, residual.purpose(shared::kDrawShadow));
        const Vec3<Real> q = medium.sigmaRatio * (densityHere(path, medium, walk, words) / walk.bound);
        const Real u = toUniform<Real>(words.x);
        if constexpr (Trace::kIsOn) {
            const double survival = double(maxComponent(weight * (Real(1) - q))) / double(threshold);
            path.trace.add(
                Decision{Decision::Kind::ShadowRoulette, vertex, residual.index, walk.index, double(u), survival});
        }
        path.trace.add(PathEvent::ShadowCollision, walk.index);
        if (!decideShadow(q, u, threshold, weight)) return false;
        residual.renew(words);
    }
    return true;
}

}  // namespace parhelion::reference
