#pragma once

#include <array>

#include "reference/volume/cloud_noise.h"

namespace parhelion::reference {

/// A field's parameters in Real, quotients included: the other half of shared::CloudArguments.
template <typename Real>
struct Cloud {
    Vec3<Real> frequency;  ///< noise cells along each axis of the unit cube
    Real blend;            ///< 0: cube, 1: blob
    Real sharpness;        ///< 1 / surfaceWidth
    Real inverseLargest;   ///< of the density that is modulated
    shared::CloudField field;
};

/// Reference only: the device gets these numbers in its arguments.
/// @param largest  of the density that is modulated; unused without.
template <typename Real>
Cloud<Real> cloudOf(const shared::CloudField& field, float largest) {
    const glm::uvec3 n = field.resolution;
    Cloud<Real> cloud{.frequency = {}, .blend = 0, .sharpness = 0, .inverseLargest = 0, .field = field};
    cloud.frequency = Real(field.noiseScale) * (Vec3<Real>(n) / Real(std::max(n.x, std::max(n.y, n.z))));
    cloud.blend = std::clamp(Real(field.detailAmount) / Real(0.85), Real(0), Real(1));
    cloud.sharpness = Real(1) / Real(field.surfaceWidth);
    cloud.inverseLargest = largest > 0 ? Real(1) / Real(largest) : Real(0);
    return cloud;
}

template <typename Real>
Real lengthPrecisely(const Vec3<Real>& v) {
    return roundedSqrt((v.x * v.x + v.y * v.y) + v.z * v.z);
}

/// Signed distance to a cube with rounded edges, about the centre of the unit cube.
template <typename Real>
Real boxDistance(const Vec3<Real>& p) {
    const Vec3<Real> a = glm::abs(p - Real(0.5)) - Real(shared::kCloudBoxCore);
    const Real outside = lengthPrecisely(glm::max(a, Real(0)));
    return (outside + std::min(maxComponent(a), Real(0))) - Real(shared::kCloudBoxRadius);
}

template <typename Real>
Real sphereDistance(const Vec3<Real>& p, const Vec3<Real>& center, Real radius) {
    return lengthPrecisely(p - center) - radius;
}

/// Distance to the heap of spheres that a cloud grows from: exact outside, a bound inside.
template <typename Real>
Real blobDistance(const Vec3<Real>& p) {
    struct Sphere {
        std::array<double, 3> center;
        double radius;
    };
    constexpr std::array<Sphere, 7> kHeap{{{{0.50, 0.44, 0.50}, 0.20},
                                           {{0.36, 0.41, 0.54}, 0.14},
                                           {{0.65, 0.42, 0.47}, 0.15},
                                           {{0.46, 0.57, 0.46}, 0.15},
                                           {{0.56, 0.40, 0.62}, 0.13},
                                           {{0.45, 0.40, 0.36}, 0.13},
                                           {{0.59, 0.54, 0.54}, 0.12}}};
    Real nearest = kInfinity<Real>;
    for (const auto& [c, radius] : kHeap)
        nearest = std::min(nearest, sphereDistance(p, Vec3<Real>(c[0], c[1], c[2]), Real(radius)));
    return nearest;
}

/// How far the surface bulges out at p, in units of detailAmount * r: in [-0.3 - erosionAmount, 0.8].
template <typename Real>
Real cloudDetail(const Cloud<Real>& cloud, const Vec3<Real>& p) {
    const std::uint32_t seed = cloud.field.noiseSeed;
    const Vec3<Real> s = cloud.frequency * p;
    const Vec3<Real> q =
        s + Real(cloud.field.warpAmount) * (Real(2) * fbm(s, seed, shared::kCloudStreamWarp) - Real(1));
    const Real billow = fbm(Real(0.55) * q, seed, shared::kCloudStreamBillow).x;
    const Real cells = worley(Real(1.65) * q, seed, shared::kCloudStreamCells);
    const Real erosion = fbm(Real(7) * q, seed, shared::kCloudStreamErosion).x;
    return Real(0.25) + Real(0.45) * (billow - Real(0.5)) + Real(0.65) * (Real(0.5) - cells) -
           Real(cloud.field.erosionAmount) * erosion;
}

/// smoothstep that falls from 1 at phi = -surfaceWidth r to 0 at surfaceWidth r, r = 1/2.
template <typename Real>
Real cloudSurface(const Cloud<Real>& cloud, Real phi) {
    const Real t = std::clamp(Real(0.5) - phi * cloud.sharpness, Real(0), Real(1));
    return t * t * (3 - 2 * t);
}

/// Density in [0, 1] of a cube that grows into a cloud as detailAmount rises.
template <typename Real>
Real displacedDensity(const Cloud<Real>& cloud, const Vec3<Real>& p) {
    const Real base = (1 - cloud.blend) * boxDistance(p) + cloud.blend * blobDistance(p);
    const Real phi = base - Real(cloud.field.detailAmount) * Real(0.5) * cloudDetail(cloud, p);
    const Real density = std::clamp(cloudSurface(cloud, phi) * Real(cloud.field.densityScale), Real(0), Real(1));
    return density < Real(cloud.field.densityThreshold) ? Real(0) : density;
}

/// A given density `base`, thinned where the detail is low: most where it is thin already, not at all at its largest.
/// In [0, base].
template <typename Real>
Real modulatedDensity(const Cloud<Real>& cloud, const Vec3<Real>& p, Real base) {
    const Real middle = Real(shared::kCloudMeanDetail) - Real(0.5) * Real(cloud.field.erosionAmount);
    const Real eroded = cloudSurface(cloud, Real(0.5) * (cloudDetail(cloud, p) - middle));
    const Real thin = 1 - base * cloud.inverseLargest;
    const Real density = base * (1 - cloud.blend * eroded * thin);
    return density < Real(cloud.field.densityThreshold) ? Real(0) : density;
}

/// The field at p in the unit cube. `base` is the density there that it modulates, if it does.
template <typename Real>
Real cloudDensity(const Cloud<Real>& cloud, const Vec3<Real>& p, Real base) {
    return cloud.field.modulates ? modulatedDensity(cloud, p, base) : displacedDensity(cloud, p);
}

}  // namespace parhelion::reference
