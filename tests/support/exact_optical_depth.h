#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace parhelion::test {

/// Optical depth along a ray through a grid of trilinear density, exactly: between planes of voxel centres the density
/// is a cubic of the distance, which Simpson's rule integrates without error.
class ExactOpticalDepth {
public:
    /// @param voxels     x fastest; values beyond the grid are those of its border.
    /// @param origin     of the ray, in voxel units (the grid spans [0, resolution]).
    /// @param direction  in voxel units per unit of the ray's distance.
    ExactOpticalDepth(std::vector<float> voxels, glm::ivec3 resolution, glm::dvec3 origin, glm::dvec3 direction,
                      double sigma, double tEnd)
        : voxels_(std::move(voxels)),
          resolution_(resolution),
          origin_(origin),
          direction_(direction),
          sigma_(sigma),
          breaks_{0.0, tEnd} {
        for (int axis = 0; axis < 3; ++axis)
            for (int plane = 0; plane < resolution[axis]; ++plane) {
                const double t = (plane + 0.5 - origin[axis]) / direction[axis];
                if (t > 0 && t < tEnd) breaks_.push_back(t);
            }
        std::sort(breaks_.begin(), breaks_.end());
        running_.push_back(0.0);
        for (std::size_t i = 1; i < breaks_.size(); ++i)
            running_.push_back(running_.back() + simpson(breaks_[i - 1], breaks_[i]));
    }

    double total() const { return running_.back(); }

    /// Optical depth of [0, t], t in [0, tEnd].
    double at(double t) const {
        const auto above = std::upper_bound(breaks_.begin(), breaks_.end(), t);
        const auto i = std::min(std::size_t(above - breaks_.begin()), breaks_.size() - 1) - 1;
        return running_[i] + simpson(breaks_[i], t);
    }

private:
    double simpson(double a, double b) const {
        return sigma_ * (b - a) * (density(a) + 4 * density((a + b) / 2) + density(b)) / 6;
    }

    double density(double t) const {
        const glm::dvec3 s = origin_ + t * direction_ - 0.5;
        const glm::dvec3 low = glm::floor(s), f = s - low;
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::ivec3 i = glm::clamp(glm::ivec3(low) + c, glm::ivec3(0), resolution_ - 1);
            const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(c));
            sum += w.x * w.y * w.z * voxels_[(std::size_t(i.z) * resolution_.y + i.y) * resolution_.x + i.x];
        }
        return sum;
    }

    std::vector<float> voxels_;
    glm::ivec3 resolution_;
    glm::dvec3 origin_, direction_;
    double sigma_;
    std::vector<double> breaks_, running_;
};

}  // namespace parhelion::test
