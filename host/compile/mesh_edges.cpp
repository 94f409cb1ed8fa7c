#include "compile/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace parhelion {

std::vector<std::uint32_t> findPlaces(std::span<const glm::dvec3> positions) {
    std::vector<std::uint32_t> order(positions.size()), places(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return key(a) < key(b) || (key(a) == key(b) && a < b);  // -0 equals 0
    });
    for (std::size_t i = 0; i < order.size(); ++i)
        places[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? places[order[i - 1]] : order[i];
    return places;
}

std::size_t joinPlaces(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> may, double tolerance,
                       std::vector<std::uint32_t>& places) {
    // A sweep along a direction that no modeller's planes are square to.
    const glm::dvec3 along(0.5377, 0.8339, 0.1258);
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const std::uint32_t place : may) order.emplace_back(glm::dot(positions[place], along), place);
    std::ranges::sort(order);
    SidedSets sets(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= tolerance; ++j)
            if (glm::distance(positions[order[i].second], positions[order[j].second]) <= tolerance)
                sets.join(order[i].second, order[j].second, false);
    std::size_t taken = 0;
    for (const std::uint32_t place : may) taken += sets.setOf(place) != place;
    for (std::uint32_t& place : places) place = sets.setOf(place);
    return taken;
}

std::vector<MeshEdge> sortedEdges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> places) {
    std::vector<MeshEdge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = places[triangles[t][k]], b = places[triangles[t][(k + 1) % 3]];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::ranges::sort(edges, {}, [](const MeshEdge& e) { return std::tuple(e.low, e.high, e.triangle, e.forward); });
    return edges;
}

SidedSets::SidedSets(std::size_t count) : parent_(count), side_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0u);
}

std::uint32_t SidedSets::setOf(std::uint32_t a) {
    // Path halving: every second member is hung on its grandparent, its side told from there.
    while (parent_[a] != a) {
        const std::uint32_t above = parent_[a];
        side_[a] = side_[a] != side_[above];
        parent_[a] = parent_[above];
        a = parent_[a];
    }
    return a;
}

bool SidedSets::sideOf(std::uint32_t a) {
    bool side = false;
    for (; parent_[a] != a; a = parent_[a]) side = side != side_[a];
    return side;
}

bool SidedSets::join(std::uint32_t a, std::uint32_t b, bool opposite) {
    const std::uint32_t p = setOf(a), q = setOf(b);
    const bool apart = sideOf(a) != sideOf(b);
    if (p == q) return apart == opposite;
    // The least member stays on top.
    const std::uint32_t top = std::min(p, q), below = std::max(p, q);
    parent_[below] = top;
    side_[below] = apart != opposite;
    return true;
}

}  // namespace parhelion
