#pragma once

#include <cstdint>
#include <vector>

#include "compile/compiled_scene.h"
#include "reference/core/math.h"

namespace parhelion::reference {

using shared::kNone;

/// Affine map, kept as columns so that a direction needs no translation.
template <typename Real>
struct Affine {
    glm::mat<3, 3, Real> linear;
    Vec3<Real> translation;

    Affine() = default;
    /// Reference only: GLSL multiplies by mat4x3 where it needs to.
    explicit Affine(const glm::mat4x3& m) : linear(glm::mat3(m[0], m[1], m[2])), translation(m[3]) {}
    /// Reference only: as above.
    Vec3<Real> point(const Vec3<Real>& p) const { return linear * p + translation; }
    /// Reference only: as above.
    Vec3<Real> vector(const Vec3<Real>& v) const { return linear * v; }
};

template <typename Real>
struct Quad {
    Vec3<Real> corner, edgeU, edgeV, normal, uFromWorld, vFromWorld;
    Real area;
    std::uint32_t shape;
    bool isNull;
};

template <typename Real>
struct Sphere {
    Vec3<Real> center;
    Real radius;
    std::uint32_t shape;
    bool isNull;
    Vec3<Real> axisX{1, 0, 0}, axisY{0, 1, 0}, axisZ{0, 0, 1};  ///< the sphere's own, unit
};

template <typename Real>
struct Box {
    Affine<Real> localFromWorld;
    std::uint32_t shape;
    bool isNull;
};

/// shared::Medium with its arrays found.
template <typename Real>
struct Medium {
    Affine<Real> gridFromWorld, albedoFromWorld;
    Vec3<Real> sigmaRatio;
    Real sigmaMax;
    Vec3<Real> albedo;
    std::uint32_t phase;                            ///< shared::kPhase*
    Real g, g2, lobeWeight;                         ///< see shared::Medium
    std::uint32_t phaseCount;                       ///< intervals of phaseTable
    const float* phaseTable = nullptr;              ///< null unless tabulated
    const glm::uvec2* phaseDistribution = nullptr;  ///< of its intervals
    glm::ivec3 resolution, cells, albedoResolution;
    std::uint32_t cellLevel = 0;
    const float* density = nullptr;             ///< first voxel (dense), or the whole brick pool
    const std::uint32_t* brickTable = nullptr;  ///< null when dense
    const float* majorants = nullptr;
    const glm::vec4* albedoVoxels = nullptr;  ///< null without an albedo grid
    bool homogeneous, grey;
    bool colored;  ///< three densities a voxel, interleaved
};

template <typename Real>
struct Light {
    Vec3<Real> emission, vector;
    std::uint32_t type, primitive, triangleCount, triangleOffset, distribution;
    Real selection, cumulative;
    bool isTwoSided;
    std::uint32_t texture = kNone;
};

/// CompiledScene in Real: the records converted once, the large arrays referred to.
///
/// The CompiledScene must outlive it.
template <typename Real>
struct SceneView {
    explicit SceneView(const CompiledScene& scene);

    const CompiledScene& source;
    const shared::SceneConstants& constants;
    std::vector<Quad<Real>> quads;
    std::vector<Sphere<Real>> spheres;
    std::vector<Box<Real>> boxes;
    std::vector<Medium<Real>> media;
    std::vector<Light<Real>> lights;  ///< in the scene's order
    std::uint32_t firstSphere, firstBox, firstTriangle;

    const shared::Shape& shapeAt(std::uint32_t index) const { return source.shapes[index]; }

    /// The medium that fills the interior of a shape (which may be kNone), or null.
    const Medium<Real>* interiorOf(std::uint32_t shape) const {
        if (shape == kNone || shapeAt(shape).interior == kNone) return nullptr;
        return &media[shapeAt(shape).interior];
    }

    /// Reference only: spelt out where the shader needs it.
    bool isNull(std::uint32_t shape) const { return (shapeAt(shape).flags & shared::kShapeNull) != 0; }

    /// Reference only: spelt out where the shader needs it.
    bool isFlipped(std::uint32_t shape) const { return (shapeAt(shape).flags & shared::kShapeFlipNormal) != 0; }

    /// Vertex 0, 1 or 2 of a triangle, counted from the first triangle.
    /// Reference only: the shader fetches texels.
    Vec3<Real> vertex(std::uint32_t triangle, std::uint32_t corner) const {
        return Vec3<Real>(source.triangles[triangle * shared::kTriangleTexels + corner]);
    }

    /// Reference only: the shader has the texel at hand.
    std::uint32_t triangleShape(std::uint32_t triangle) const {
        return glm::floatBitsToUint(source.triangles[triangle * shared::kTriangleTexels].w);
    }
};

/// Reference only: the shader reads the records as they are.
template <typename Real>
Medium<Real> viewMedium(const CompiledScene& scene, const shared::Medium& m) {
    Medium<Real> v;
    v.gridFromWorld = Affine<Real>(m.gridFromWorld);
    v.albedoFromWorld = Affine<Real>(m.albedoFromWorld);
    v.sigmaRatio = m.sigmaRatio;
    v.sigmaMax = m.sigmaMax;
    v.albedo = m.albedo;
    v.phase = m.phase;
    v.g = m.g;
    v.g2 = m.g2;
    v.lobeWeight = m.lobeWeight;
    v.phaseCount = m.phaseCount;
    if (m.phase == shared::kPhaseTabulated) {
        v.phaseTable = scene.phaseTable.data() + m.phaseOffset;
        v.phaseDistribution = scene.distributions.data() + m.phaseDistribution;
    }
    v.resolution = m.resolution;
    v.cells = m.cells;
    v.cellLevel = m.cellLevel;
    v.albedoResolution = m.albedoResolution;
    v.homogeneous = (m.flags & shared::kMediumHomogeneous) != 0;
    v.colored = (m.flags & shared::kMediumColorDensity) != 0;
    v.grey = m.sigmaRatio == glm::vec3(1.0f) && !v.colored;
    if (!v.homogeneous) {
        const bool bricked = (m.flags & shared::kMediumBricked) != 0;
        v.density = scene.density.data() + (bricked ? 0 : m.voxelOffset);
        if (bricked) v.brickTable = scene.brickTable.data() + m.voxelOffset;
        v.majorants = scene.majorants.data() + m.cellOffset;
    }
    if (m.flags & shared::kMediumAlbedoGrid) v.albedoVoxels = scene.albedoVoxels.data() + m.albedoOffset;
    return v;
}

/// Reference only: the shader reads the records as they are.
template <typename Real>
SceneView<Real>::SceneView(const CompiledScene& scene) : source(scene), constants(scene.constants) {
    const shared::SceneConstants& c = constants;
    firstSphere = c.quadCount;
    firstBox = firstSphere + c.sphereCount;
    firstTriangle = firstBox + c.boxCount;
    for (std::uint32_t i = 0; i < c.quadCount; ++i) {
        const shared::Quad& q = c.quads[i];
        quads.push_back(
            {q.corner, q.edgeU, q.edgeV, q.normal, q.uFromWorld, q.vFromWorld, Real(q.area), q.shape, isNull(q.shape)});
    }
    for (std::uint32_t i = 0; i < c.sphereCount; ++i) {
        const shared::Sphere& s = c.spheres[i];
        const Vec3<Real> x(s.axisX), z(s.axisZ);
        spheres.push_back(
            {s.center, Real(s.radius), s.shape, isNull(s.shape), x, glm::cross(z, x) * Real(s.handedness), z});
    }
    for (std::uint32_t i = 0; i < c.boxCount; ++i)
        boxes.push_back({Affine<Real>(c.boxes[i].localFromWorld), c.boxes[i].shape, isNull(c.boxes[i].shape)});
    for (std::uint32_t i = 0; i < c.mediumCount; ++i) media.push_back(viewMedium<Real>(scene, c.media[i]));
    for (std::uint32_t i = 0; i < c.lightCount; ++i) {
        const shared::Light& l = c.lights[i];
        lights.push_back({l.emission, l.vector, l.type, l.primitive, l.triangleCount, l.triangleOffset, l.distribution,
                          Real(l.selection), Real(l.cumulative), (l.flags & shared::kLightTwoSided) != 0, l.texture});
    }
}

}  // namespace parhelion::reference
