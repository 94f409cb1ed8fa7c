#include "compile/triangle_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace parhelion {

namespace {

constexpr std::uint32_t kLeafSize = 4;

glm::dvec3 middleOf(const Corners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

}  // namespace

TriangleTree::TriangleTree(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!triangles_.empty()) build(0, std::uint32_t(triangles_.size()));
}

/// Halves the triangles at the median of their middles along the longest axis.
void TriangleTree::build(std::uint32_t first, std::uint32_t count) {
    Node node{glm::dvec3(std::numeric_limits<double>::infinity()), {}, first, count, 0};
    node.upper = -node.lower;
    for (std::uint32_t i = first; i < first + count; ++i)
        for (const glm::dvec3& corner : triangles_[order_[i]]) {
            node.lower = glm::min(node.lower, corner);
            node.upper = glm::max(node.upper, corner);
        }
    const std::size_t index = nodes_.size();
    const bool isLeaf = count <= kLeafSize;
    if (!isLeaf) node.count = 0;
    nodes_.push_back(node);
    if (!isLeaf) {
        const glm::dvec3 size = node.upper - node.lower;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const auto begin = order_.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
            return middleOf(triangles_[a])[axis] < middleOf(triangles_[b])[axis];
        });
        build(first, count / 2);
        build(first + count / 2, count - count / 2);
    }
    nodes_[index].skip = std::uint32_t(nodes_.size());
}

bool TriangleTree::meets(const Node& node, const glm::dvec3& origin, const glm::dvec3& inverse) {
    const glm::dvec3 a = (node.lower - origin) * inverse, b = (node.upper - origin) * inverse;
    const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
    const double entry = std::max({low.x, low.y, low.z, 0.0}), exit = std::min({high.x, high.y, high.z});
    return entry <= exit * (1.0 + 1e-12);
}

/// Source: Moller, Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
int TriangleTree::crossing(const Corners& triangle, const glm::dvec3& origin, const glm::dvec3& direction) {
    const glm::dvec3 e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0];
    const glm::dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) return 0;
    const glm::dvec3 s = origin - triangle[0], q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(glm::dot(e2, q) / determinant > 0.0)) return 0;
    return determinant > 0.0 ? -1 : 1;
}

bool surrounds(const TriangleTree& surface, const glm::dvec3& point) {
    int votes = 0;
    for (const glm::dvec3& direction : kProbeDirections) {
        bool odd = false;
        surface.visitRay(point, direction, [&](std::uint32_t, int) { odd = !odd; });
        votes += odd;
    }
    return votes >= 2;
}

}  // namespace parhelion
