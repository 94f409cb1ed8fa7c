#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace parhelion {

/// One side of a triangle, between two places.
struct MeshEdge {
    std::uint32_t low, high;  ///< the places, low < high
    std::uint32_t triangle;
    bool forward;  ///< the triangle runs from low to high
};

/// Numbers the places that vertices take: vertices at the same coordinates have one, as files that split them by
/// normals or texture coordinates need. A place is the least index of its vertices.
std::vector<std::uint32_t> findPlaces(std::span<const glm::dvec3> positions);

/// Joins places that are less than `tolerance` apart, among those that `may` names; chains of them become one.
/// @return how many places another took over.
std::size_t joinPlaces(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> may, double tolerance,
                       std::vector<std::uint32_t>& places);

/// The edges of all triangles, sorted by their ends; none for sides that begin and end at one place.
std::vector<MeshEdge> sortedEdges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> places);

/// Calls visit(edges) for every run of edges with the same ends.
template <typename Visit>
void forEachEdge(std::span<const MeshEdge> edges, const Visit& visit) {
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t end = first + 1;
        while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) ++end;
        visit(edges.subspan(first, end - first));
        first = end;
    }
}

/// Sets of things, each with a side: which of the two sides it is on relative to the others of its set.
class SidedSets {
public:
    explicit SidedSets(std::size_t count);
    /// Puts a and b into one set, on the same side or on opposite ones.
    /// @return false if they are in one set already, and otherwise.
    bool join(std::uint32_t a, std::uint32_t b, bool opposite);
    std::uint32_t setOf(std::uint32_t a);
    bool sideOf(std::uint32_t a);

private:
    std::vector<std::uint32_t> parent_;
    std::vector<bool> side_;  ///< relative to the parent
};

}  // namespace parhelion
