#include "compile/closed_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compile/mesh_edges.h"
#include "compile/triangle_tree.h"

namespace parhelion {

namespace {

/// An edge and how often triangles run along it, from low to high less from high to low.
struct EdgeUse {
    std::uint32_t low, high;
    int count, net;
};

class MeshCloser {
public:
    explicit MeshCloser(PlacedShape& placed) : placed_(placed), places_(findPlaces(placed.source->mesh.positions)) {
        placed.triangles = placed.source->mesh.triangles;
        edges_ = sortedEdges(placed.triangles, places_);
    }

    std::vector<std::string> close() {
        moveTogether();
        requireClosed();
        turnAgainstNeighbours();
        requireOneOrientation();
        findParts();
        requireOutside();
        turnPartsInsideOut();
        if (turned_ > 0)
            note(fmt::format(
                "{} of its {} triangles were turned: they were wound against their neighbours, or their part "
                "of the mesh was inside out",
                turned_, placed_.triangles.size()));
        return std::move(notes_);
    }

private:
    const ShapeDescription& source() const { return *placed_.source; }

    std::string positionOf(std::uint32_t vertex) const {
        const glm::dvec3 p(source().toWorld * glm::dvec4(source().mesh.positions[vertex], 1.0));
        return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
    }

    void note(const std::string& text) {
        notes_.push_back(fmt::format("{}: {}: {}", source().where.text(), nameOf(source()), text));
    }

    [[noreturn]] void fail(const std::string& text) const {
        throw InputError(source().where, fmt::format("{}: {}", nameOf(source()), text));
    }

    /// What six written digits, or single precision, leave open, in the mesh's own space; of a mesh that is far from
    /// its own origin not more than what is small against the mesh.
    double tolerance() const {
        glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
        for (const glm::dvec3& p : source().mesh.positions) {
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        const glm::dvec3 largest = glm::max(glm::abs(lower), glm::abs(upper)), size = upper - lower;
        return std::min(0x1p-18 * std::max({largest.x, largest.y, largest.z}),
                        0x1p-10 * std::max({size.x, size.y, size.z}));
    }

    std::vector<EdgeUse> usesWhere(bool (*wanted)(const EdgeUse&)) const {
        std::vector<EdgeUse> uses;
        forEachEdge(edges_, [&](std::span<const MeshEdge> same) {
            EdgeUse use{same.front().low, same.front().high, int(same.size()), 0};
            for (const MeshEdge& edge : same) use.net += edge.forward ? 1 : -1;
            if (wanted(use)) uses.push_back(use);
        });
        return uses;
    }

    static bool isOdd(const EdgeUse& use) { return use.count % 2 != 0; }
    static bool isUneven(const EdgeUse& use) { return use.net != 0; }

    static std::vector<std::uint32_t> endsOf(std::span<const EdgeUse> uses) {
        std::vector<std::uint32_t> ends;
        for (const EdgeUse& use : uses) ends.insert(ends.end(), {use.low, use.high});
        std::ranges::sort(ends);
        ends.erase(std::ranges::unique(ends).begin(), ends.end());
        return ends;
    }

    void moveTogether() {
        const std::vector<EdgeUse> open = usesWhere(isOdd);
        if (open.empty()) return;
        const std::size_t moved = joinPlaces(source().mesh.positions, endsOf(open), tolerance(), places_);
        if (moved == 0) return;
        edges_ = sortedEdges(placed_.triangles, places_);
        for (std::size_t i = 0; i < places_.size(); ++i) placed_.vertices[i] = placed_.vertices[places_[i]];
        note(fmt::format("{} of its vertices were moved onto others within {:.3g}, to close gaps of rounding", moved,
                         tolerance()));
    }

    /// Cuts edges at the vertices that lie on them: several short edges may close a long one (as a finer neighbour
    /// has).
    /// @return those that are `wanted` still.
    std::vector<EdgeUse> cutAtVertices(const std::vector<EdgeUse>& uses, bool (*wanted)(const EdgeUse&)) const {
        constexpr std::size_t kMost = 4096;  // edges times ends
        if (uses.empty() || uses.size() > kMost) return uses;
        const std::vector<std::uint32_t> ends = endsOf(uses);
        const double within = tolerance();
        std::vector<EdgeUse> pieces;
        for (const EdgeUse& use : uses) {
            std::uint32_t from = use.low;
            for (const std::uint32_t end : verticesAlong(use, ends, within)) {
                pieces.push_back(
                    {std::min(from, end), std::max(from, end), use.count, from < end ? use.net : -use.net});
                from = end;
            }
        }
        return mergedUses(pieces, wanted);
    }

    /// Ends within an edge in their order along it, and its own far end.
    std::vector<std::uint32_t> verticesAlong(const EdgeUse& use, std::span<const std::uint32_t> ends,
                                             double within) const {
        const std::vector<glm::dvec3>& positions = source().mesh.positions;
        const glm::dvec3 start = positions[use.low], edge = positions[use.high] - start;
        const double length = glm::length(edge);
        std::vector<std::pair<double, std::uint32_t>> found;
        for (const std::uint32_t end : ends) {
            const glm::dvec3 from = positions[end] - start;
            const double along = glm::dot(from, edge) / length;
            if (along <= within || along >= length - within) continue;
            if (glm::length(from - edge * (along / length)) <= within) found.emplace_back(along, end);
        }
        std::ranges::sort(found);
        std::vector<std::uint32_t> order;
        for (const auto& [along, end] : found) order.push_back(end);
        order.push_back(use.high);
        return order;
    }

    static std::vector<EdgeUse> mergedUses(std::vector<EdgeUse> pieces, bool (*wanted)(const EdgeUse&)) {
        std::ranges::sort(pieces, {}, [](const EdgeUse& use) { return std::pair(use.low, use.high); });
        std::vector<EdgeUse> merged;
        for (const EdgeUse& piece : pieces) {
            if (merged.empty() || merged.back().low != piece.low || merged.back().high != piece.high) {
                merged.push_back(piece);
                continue;
            }
            merged.back().count += piece.count;
            merged.back().net += piece.net;
        }
        std::erase_if(merged, [&](const EdgeUse& use) { return !wanted(use); });
        return merged;
    }

    std::string between(const EdgeUse& use) const {
        return fmt::format("from {} to {}", positionOf(use.low), positionOf(use.high));
    }

    void requireClosed() const {
        const std::vector<EdgeUse> open = cutAtVertices(usesWhere(isOdd), isOdd);
        if (open.empty()) return;
        const auto single = std::size_t(std::ranges::count(open, 1, &EdgeUse::count));
        fail(fmt::format(
            "a medium needs a closed mesh; this one has {} edges with one triangle{}, one of them {}: fill "
            "its holes and merge its vertices",
            single, single < open.size() ? fmt::format(" and {} with three or more", open.size() - single) : "",
            between(open.front())));
    }

    void turn(std::uint32_t triangle) {
        std::swap(placed_.triangles[triangle].y, placed_.triangles[triangle].z);
        ++turned_;
    }

    /// Of each set of triangles that hang together by their edges, the fewer are turned.
    void turnAgainstNeighbours() {
        if (usesWhere(isUneven).empty()) return;
        SidedSets sets(placed_.triangles.size());
        forEachEdge(edges_, [&](std::span<const MeshEdge> same) {
            if (same.size() != 2) return;
            if (!sets.join(same[0].triangle, same[1].triangle, same[0].forward == same[1].forward))
                fail(
                    fmt::format("a medium needs a surface with two sides; this one comes back on its other side (as a "
                                "Moebius strip does), at the edge from {} to {}",
                                positionOf(same[0].low), positionOf(same[0].high)));
        });
        std::vector<std::size_t> all(placed_.triangles.size(), 0), turned(placed_.triangles.size(), 0);
        for (std::uint32_t t = 0; t < placed_.triangles.size(); ++t) {
            const std::uint32_t set = sets.setOf(t);
            ++all[set];
            turned[set] += sets.sideOf(t);
        }
        for (std::uint32_t t = 0; t < placed_.triangles.size(); ++t) {
            const std::uint32_t set = sets.setOf(t);
            if (turned[set] > 0 && sets.sideOf(t) == (2 * turned[set] <= all[set])) turn(t);
        }
        mayTurnParts_ = true;
        edges_ = sortedEdges(placed_.triangles, places_);
    }

    void requireOneOrientation() const {
        const std::vector<EdgeUse> uneven = cutAtVertices(usesWhere(isUneven), isUneven);
        if (uneven.empty()) return;
        fail(fmt::format(
            "a medium needs a mesh whose triangles face one way; this one has {} edges where they disagree and "
            "more than two meet, one of them {}",
            uneven.size(), between(uneven.front())));
    }

    /// Numbers the parts of the mesh that hang together, and their signed volumes.
    void findParts() {
        SidedSets sets(placed_.triangles.size());
        forEachEdge(edges_, [&](std::span<const MeshEdge> same) {
            for (const MeshEdge& edge : same) sets.join(same.front().triangle, edge.triangle, false);
        });
        placed_.parts.assign(placed_.triangles.size(), 0);
        std::vector<std::uint32_t> numbers(placed_.triangles.size(), 0);
        for (std::uint32_t t = 0; t < placed_.triangles.size(); ++t) {
            const std::uint32_t set = sets.setOf(t);  // the least triangle of the part
            if (set == t) {
                numbers[t] = std::uint32_t(volumes_.size());
                volumes_.push_back(0.0);
                firsts_.push_back(t);
            }
            placed_.parts[t] = numbers[set];
        }
        for (std::uint32_t t = 0; t < placed_.triangles.size(); ++t) {
            const glm::dvec3 apex = placed_.vertices[placed_.triangles[firsts_[placed_.parts[t]]].x];
            const Corners c = cornersOf(placed_, t);
            volumes_[placed_.parts[t]] += glm::dot(c[0] - apex, glm::cross(c[1] - apex, c[2] - apex)) / 6.0;
        }
        placed_.volume = 0.0;
        for (const double volume : volumes_) placed_.volume += volume;
    }

    void requireOutside() const {
        if (placed_.volume > 0.0 || (mayTurnParts_ && placed_.volume < 0.0)) return;
        fail(fmt::format(
            "a medium needs a closed mesh with normals that point outwards (try flip_normals); got a signed "
            "volume of {}",
            placed_.volume));
    }

    /// A part that faces inwards is a hole if it lies within another part; elsewhere it is inside out.
    void turnPartsInsideOut() {
        const glm::dvec3 size = placed_.upper - placed_.lower;
        const double flat = 1e-12 * size.x * size.y * size.z;  // sheets enclose nothing, but for rounding
        if (std::ranges::none_of(volumes_, [flat](double volume) { return volume < -flat; })) return;
        const TriangleTree tree(surfaceOf(placed_));
        std::vector<bool> turns(volumes_.size());
        for (std::uint32_t part = 0; part < volumes_.size(); ++part)
            if (volumes_[part] < -flat && !isWithinOthers(tree, part)) {
                turns[part] = true;
                placed_.volume -= 2.0 * volumes_[part];
            }
        for (std::uint32_t t = 0; t < placed_.triangles.size(); ++t)
            if (turns[placed_.parts[t]]) turn(t);
    }

    bool isWithinOthers(const TriangleTree& tree, std::uint32_t part) const {
        const Corners& first = tree.triangles()[firsts_[part]];
        const glm::dvec3 point = (first[0] + first[1] + first[2]) / 3.0;
        int votes = 0;
        for (const glm::dvec3& direction : kProbeDirections) {
            bool odd = false;
            tree.visitRay(point, direction, [&](std::uint32_t t, int) { odd = odd != (placed_.parts[t] != part); });
            votes += odd;
        }
        return votes >= 2;
    }

    PlacedShape& placed_;
    std::vector<std::uint32_t> places_;
    std::vector<MeshEdge> edges_;
    std::vector<double> volumes_;        ///< by part, > 0 where it faces outwards
    std::vector<std::uint32_t> firsts_;  ///< by part: its first triangle
    std::size_t turned_ = 0;
    bool mayTurnParts_ = false;
    std::vector<std::string> notes_;
};

}  // namespace

std::vector<std::string> closeMesh(PlacedShape& placed) { return MeshCloser(placed).close(); }

}  // namespace parhelion
