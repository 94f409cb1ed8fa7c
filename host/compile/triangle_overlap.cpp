#include "compile/triangle_overlap.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace parhelion {

namespace {

/// Part of a line, as positions along it.
struct Span {
    double low, high;
};

/// Signed distances of a triangle's corners from a plane; none unless they are beyond `tolerance` on both sides.
std::optional<glm::dvec3> distancesAcross(const Corners& triangle, const glm::dvec3& on, const glm::dvec3& normal,
                                          double tolerance) {
    const glm::dvec3 d(glm::dot(triangle[0] - on, normal), glm::dot(triangle[1] - on, normal),
                       glm::dot(triangle[2] - on, normal));
    const bool across = std::min({d.x, d.y, d.z}) < -tolerance && std::max({d.x, d.y, d.z}) > tolerance;
    return across ? std::optional(d) : std::nullopt;
}

/// Where a triangle whose corners have distances `d` from a plane meets it, along a line in that plane.
Span spanOn(const Corners& triangle, const glm::dvec3& d, const glm::dvec3& on, const glm::dvec3& along) {
    Span span{1e300, -1e300};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (d[i] * d[j] > 0.0 || d[i] == d[j]) continue;
        const glm::dvec3 p = triangle[i] + (triangle[j] - triangle[i]) * (d[i] / (d[i] - d[j]));
        const double position = glm::dot(p - on, along);
        span.low = std::min(span.low, position);
        span.high = std::max(span.high, position);
    }
    return span;
}

/// The length of line that both hold and a point of its middle; length below 0: none.
struct Common {
    double length = -1.0;
    glm::dvec3 middle{0.0};
};

Common commonLine(const Corners& a, const Corners& b, double tolerance) {
    const glm::dvec3 na = unitNormal(a), nb = unitNormal(b), along = glm::cross(na, nb);
    const double sine = glm::length(along);
    if (!(sine > 1e-12)) return {};
    const auto ofB = distancesAcross(b, a[0], na, tolerance);
    if (!ofB) return {};
    const auto ofA = distancesAcross(a, b[0], nb, tolerance);
    if (!ofA) return {};
    const Span p = spanOn(a, *ofA, a[0], along / sine), q = spanOn(b, *ofB, a[0], along / sine);
    const double low = std::max(p.low, q.low), high = std::min(p.high, q.high);
    // A point of the line: a[0] moved within a's plane onto b's.
    const glm::dvec3 across = glm::cross(along / sine, na);
    const glm::dvec3 onLine = a[0] - across * ((*ofA)[0] / glm::dot(across, nb));
    return {high - low, onLine + along / sine * (0.5 * (low + high))};
}

}  // namespace

glm::dvec3 unitNormal(const Corners& t) {
    const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double length = glm::length(n);
    return length > 0.0 ? n / length : glm::dvec3(0.0);
}

bool pierce(const Corners& a, const Corners& b, double tolerance) {
    return commonLine(a, b, tolerance).length > tolerance;
}

glm::dvec3 piercedPoint(const Corners& a, const Corners& b) { return commonLine(a, b, 0.0).middle; }

double distanceTo(const Corners& t, const glm::dvec3& point) {
    const glm::dvec3 n = unitNormal(t);
    bool above = glm::dot(n, n) > 0.0;
    double nearest = 1e300;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 edge = t[(i + 1) % 3] - t[i], from = point - t[i];
        const double square = glm::dot(edge, edge);
        const double along = square > 0.0 ? std::clamp(glm::dot(from, edge) / square, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(from - along * edge));
        above = above && glm::dot(glm::cross(n, edge), from) >= 0.0;
    }
    return above ? std::abs(glm::dot(n, point - t[0])) : nearest;
}

}  // namespace parhelion
