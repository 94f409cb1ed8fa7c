#include <gtest/gtest.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>  // Debian 13
#else
#include <embree3/rtcore.h>  // Debian 12
#endif

#include <algorithm>
#include <cmath>

#include "unit/bvh_soups.h"

namespace parhelion {
namespace {

using namespace soups;

/// Embree's robust mode over a soup.
class EmbreeScene {
public:
    explicit EmbreeScene(const Soup& soup) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * soup.triangles.size()));
        auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), soup.triangles.size()));
        for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) vertices[3 * i + k] = soup.triangles[i][k];
            indices[i] = {3 * i, 3 * i + 1, 3 * i + 2};
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    double closestHit(const Ray& ray) const {
        RTCRayHit query{};
        query.ray.org_x = float(ray.origin.x), query.ray.org_y = float(ray.origin.y),
        query.ray.org_z = float(ray.origin.z);
        query.ray.dir_x = float(ray.direction.x), query.ray.dir_y = float(ray.direction.y);
        query.ray.dir_z = float(ray.direction.z);
        query.ray.tfar = std::numeric_limits<float>::infinity();
        query.ray.mask = ~0u;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        intersect(query);
        return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kMiss : double(query.ray.tfar);
    }

private:
    void intersect(RTCRayHit& query) const {
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene_, &query);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &query);
#endif
    }

    RTCDevice device_;
    RTCScene scene_;
};

// Embree computes in float from coordinates up to 3: eight roundings of those.
constexpr double kLengthError = 8 * 3 * 0x1p-24;

/// |cosine| between ray and normal: what a length error grows by, inverted.
double cosineOf(const TriangleVertices& t, const Ray& ray) {
    const glm::dvec3 normal = glm::cross(glm::dvec3(t[1]) - glm::dvec3(t[0]), glm::dvec3(t[2]) - glm::dvec3(t[0]));
    return std::abs(glm::dot(glm::normalize(normal), ray.direction));
}

/// The ray passes an edge of the triangle closer than float can tell the sides apart.
bool grazesEdge(const TriangleVertices& t, const Ray& ray) {
    const glm::dvec3 a(t[0]), e1 = glm::dvec3(t[1]) - a, e2 = glm::dvec3(t[2]) - a;
    const glm::dvec3 p = glm::cross(ray.direction, e2), s = ray.origin - a, q = glm::cross(s, e1);
    const double determinant = glm::dot(e1, p);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(ray.direction, q) / determinant;
    const double longest = std::max({glm::length(e1), glm::length(e2), glm::distance(e1, e2)});
    const double height = glm::length(glm::cross(e1, e2)) / longest;
    return std::abs(std::min({u, v, 1.0 - u - v})) * height * cosineOf(t, ray) < kLengthError;
}

/// Rounding alone accounts for two different answers.
bool roundingExplains(const Soup& soup, const Ray& ray, double ours, double theirs) {
    for (const TriangleVertices& triangle : soup.triangles) {
        if (grazesEdge(triangle, ray)) return true;
        const bool isOurHit = intersect(triangle, ray) == ours && ours < kMiss;
        if (isOurHit && std::abs(ours - theirs) * cosineOf(triangle, ray) <= kLengthError) return true;
    }
    return false;
}

TEST(BvhAgainstEmbree, FindsTheSameHits) {
    for (const Soup& soup : {randomSoup(20'000, 0.05f), randomSoup(300, 2.0f), coplanarGrid()}) {
        const EmbreeScene embree(soup);
        const Bvh bvh = buildBvh(soup.triangles);
        int hits = 0, explained = 0, wrong = 0;
        for (const Ray& ray : raysFor(soup, 20'000)) {
            const double ours = closestHit(bvh, soup.triangles, ray).distance, theirs = embree.closestHit(ray);
            hits += ours < kMiss;
            if (ours == theirs || std::abs(ours - theirs) <= kLengthError) continue;
            roundingExplains(soup, ray, ours, theirs) ? ++explained : ++wrong;
        }
        EXPECT_EQ(wrong, 0) << soup.name << ", " << explained << " differences by rounding";
        // A quarter of the half that aims at triangles aims at a corner; far fewer of those may be undecided.
        EXPECT_LT(explained, hits / 50) << soup.name << ": the comparison decides too little";
    }
}

}  // namespace
}  // namespace parhelion
