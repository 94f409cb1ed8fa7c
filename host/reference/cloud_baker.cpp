#include "reference/cloud_baker.h"

#include "base/parallel.h"
#include "reference/volume/procedural_cloud.h"

namespace parhelion::reference {

template <typename Real>
std::vector<float> bakeCloud(const shared::CloudField& field, std::span<const float> base, float largest) {
    const glm::uvec3 n = field.resolution;
    const Cloud<Real> cloud = cloudOf<Real>(field, largest);
    const Vec3<Real> voxelSize = Real(1) / Vec3<Real>(n);
    std::vector<float> density(std::size_t(n.x) * n.y * n.z);
    parallelFor(std::size_t(n.y) * n.z, [&](std::size_t row) {
        for (unsigned x = 0; x < n.x; ++x) {
            const std::size_t voxel = row * n.x + x;
            const Vec3<Real> p = (Vec3<Real>(x, row % n.y, row / n.y) + Real(0.5)) * voxelSize;
            density[voxel] = float(cloudDensity(cloud, p, base.empty() ? Real(0) : Real(base[voxel])));
        }
    });
    return density;
}

template std::vector<float> bakeCloud<float>(const shared::CloudField&, std::span<const float>, float);
template std::vector<float> bakeCloud<double>(const shared::CloudField&, std::span<const float>, float);

double cloudDensityAt(const shared::CloudField& field, const glm::dvec3& p, double base, float largest) {
    return cloudDensity(cloudOf<double>(field, largest), p, base);
}

}  // namespace parhelion::reference
