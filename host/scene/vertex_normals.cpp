#include "scene/vertex_normals.h"

#include <cmath>

namespace parhelion {
namespace {

/// Angle between two edges; atan2 stays accurate where acos of the cosine does not, near 0 and pi.
double angleBetween(glm::dvec3 a, glm::dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

}  // namespace

std::optional<std::vector<glm::dvec3>> smoothNormals(const std::vector<glm::dvec3>& positions,
                                                     const std::vector<glm::uvec3>& triangles,
                                                     std::size_t& undefinedVertex) {
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
    std::vector<double> angles(positions.size(), 0.0);
    for (const glm::uvec3& triangle : triangles) {
        const glm::dvec3 corners[3] = {positions[triangle.x], positions[triangle.y], positions[triangle.z]};
        const glm::dvec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double length = glm::length(area);
        if (!(length > 0.0)) continue;
        for (int i = 0; i < 3; ++i) {
            const double angle = angleBetween(corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]);
            sums[triangle[i]] += area / length * angle;
            angles[triangle[i]] += angle;
        }
    }
    constexpr double kCancelled = 1e-6;  // what single precision positions leave of an exact cancellation
    for (std::size_t vertex = 0; vertex < sums.size(); ++vertex) {
        const double length = glm::length(sums[vertex]);
        if (angles[vertex] == 0.0) {
            sums[vertex] = {0.0, 0.0, 1.0};
        } else if (length <= kCancelled * angles[vertex]) {
            undefinedVertex = vertex;
            return std::nullopt;
        } else {
            sums[vertex] /= length;
        }
    }
    return sums;
}

}  // namespace parhelion
