#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace parhelion {

using Corners = std::array<glm::dvec3, 3>;

/// A tree of boxes over triangles in double: for questions about shapes, not for rendering.
class TriangleTree {
public:
    TriangleTree() = default;
    explicit TriangleTree(std::vector<Corners> triangles);

    std::span<const Corners> triangles() const { return triangles_; }

    /// Calls visit(i) for every triangle whose box meets [lower, upper].
    template <typename Visit>
    void visitBox(const glm::dvec3& lower, const glm::dvec3& upper, const Visit& visit) const {
        traverse(
            [&](const Node& node) {
                return glm::all(glm::lessThanEqual(node.lower, upper)) &&
                       glm::all(glm::greaterThanEqual(node.upper, lower));
            },
            visit);
    }

    /// Calls visit(i, turn) for every triangle that the half-line from `origin` pierces; turn is +1 where it leaves by
    /// the front (the side from which the corners run counterclockwise), -1 where it enters by it.
    template <typename Visit>
    void visitRay(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const {
        const glm::dvec3 inverse = 1.0 / direction;
        traverse([&](const Node& node) { return meets(node, origin, inverse); },
                 [&](std::uint32_t i) {
                     if (const int turn = crossing(triangles_[i], origin, direction)) visit(i, turn);
                 });
    }

private:
    struct Node {
        glm::dvec3 lower, upper;
        std::uint32_t first, count;  ///< of order_; count 0: an inner node, whose first child is the next node
        std::uint32_t skip;          ///< the node after this one and all below it
    };

    template <typename Accept, typename Visit>
    void traverse(const Accept& accept, const Visit& visit) const {
        for (std::uint32_t n = 0; n < nodes_.size();) {
            const Node& node = nodes_[n];
            if (!accept(node)) {
                n = node.skip;
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(order_[i]);
            ++n;
        }
    }

    static bool meets(const Node& node, const glm::dvec3& origin, const glm::dvec3& inverse);
    static int crossing(const Corners& triangle, const glm::dvec3& origin, const glm::dvec3& direction);
    void build(std::uint32_t first, std::uint32_t count);

    std::vector<Corners> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;  ///< each before all below it
};

/// Half-lines along these tell inside from outside. No modeller aligns edges with them; a graze spoils one at most.
inline const std::array<glm::dvec3, 3> kProbeDirections = {
    {{0.5377, 0.8339, -0.2588}, {-0.8622, 0.3188, 0.4277}, {0.1326, -0.5436, 0.8262}}};

/// Whether a closed surface surrounds `point`: an odd number of crossings, by the majority of three directions.
bool surrounds(const TriangleTree& surface, const glm::dvec3& point);

}  // namespace parhelion
