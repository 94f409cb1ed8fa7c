#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "base/parallel.h"
#include "compile/closed_mesh.h"
#include "compile/mesh_edges.h"
#include "compile/triangle_overlap.h"

namespace parhelion {

namespace {

/// The lowest triangle at fault, so that messages do not depend on threads.
class FirstFault {
public:
    void report(std::uint32_t triangle) {
        ++count_;
        std::uint32_t before = first_;
        while (triangle < before && !first_.compare_exchange_weak(before, triangle)) {
        }
    }
    std::size_t count() const { return count_; }
    std::uint32_t first() const { return first_; }

private:
    std::atomic<std::size_t> count_{0};
    std::atomic<std::uint32_t> first_{std::numeric_limits<std::uint32_t>::max()};
};

class InteriorCheck {
public:
    explicit InteriorCheck(const PlacedShape& placed)
        : placed_(placed), tree_(surfaceOf(placed)), places_(findPlaces(placed.vertices)) {
        const glm::dvec3 size = placed.upper - placed.lower;
        tolerance_ = 1e-6 * std::max({size.x, size.y, size.z});
    }

    std::vector<std::string> run() {
        parallelFor(
            tree_.triangles().size(), [&](std::size_t t) { checkPiercing(std::uint32_t(t)); }, 64);
        const std::size_t stride = 1 + tree_.triangles().size() / kMostProbes;
        parallelFor(
            tree_.triangles().size() / stride, [&](std::size_t i) { checkWinding(std::uint32_t(i * stride)); }, 64);
        if (between_.count() > 0)
            throw InputError(
                source().where,
                fmt::format("{}: the parts of a medium's mesh must be apart, or holes in one another; this one "
                            "has parts that overlap, near {}: unite them, or give them media of their own",
                            nameOf(source()), placeOf(between_.first())));
        if (within_.count() == 0) return {};
        return {
            fmt::format("{}: {}: the mesh overlaps itself near {}: where it does, a ray is in the medium from where it "
                        "first enters to where it first leaves",
                        source().where.text(), nameOf(source()), placeOf(within_.first()))};
    }

private:
    static constexpr std::size_t kMostProbes = 200'000;  // more triangles are probed one by one no longer

    const ShapeDescription& source() const { return *placed_.source; }

    glm::dvec3 middleOf(std::uint32_t triangle) const {
        const Corners& t = tree_.triangles()[triangle];
        return (t[0] + t[1] + t[2]) / 3.0;
    }

    std::string placeOf(std::uint32_t triangle) const {
        const glm::dvec3 origin = glm::dvec3(source().toWorld[3]) - glm::dvec3(placed_.toScene[3]);
        const glm::dvec3 p = middleOf(triangle) + origin;
        return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
    }

    bool shareCorner(std::uint32_t a, std::uint32_t b) const {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (places_[placed_.triangles[a][i]] == places_[placed_.triangles[b][j]]) return true;
        return false;
    }

    void checkPiercing(std::uint32_t a) {
        const Corners& t = tree_.triangles()[a];
        tree_.visitBox(glm::min(glm::min(t[0], t[1]), t[2]), glm::max(glm::max(t[0], t[1]), t[2]),
                       [&](std::uint32_t b) {
                           if (b <= a || shareCorner(a, b) || !pierce(t, tree_.triangles()[b], tolerance_)) return;
                           (placed_.parts[a] == placed_.parts[b] ? within_ : between_).report(a);
                       });
    }

    /// How often a point just within a triangle is inside its own part, and inside all others.
    struct Winding {
        int own = 0, others = 0;
    };

    Winding windingAt(std::uint32_t triangle, const glm::dvec3& point, const glm::dvec3& direction) const {
        Winding winding;
        tree_.visitRay(point, direction, [&](std::uint32_t t, int turn) {
            (placed_.parts[t] == placed_.parts[triangle] ? winding.own : winding.others) += turn;
        });
        return winding;
    }

    /// Just within a triangle is inside once: inside its own part and no other, or within its hole in another.
    void checkWinding(std::uint32_t triangle) {
        const Corners& t = tree_.triangles()[triangle];
        const glm::dvec3 normal = unitNormal(t);
        const double longest =
            std::max({glm::distance(t[0], t[1]), glm::distance(t[1], t[2]), glm::distance(t[2], t[0])});
        const double height = longest > 0.0 ? glm::length(glm::cross(t[1] - t[0], t[2] - t[0])) / longest : 0.0;
        if (!(height > 1e-6 * longest)) return;  // a sliver's inside is anywhere
        const glm::dvec3 point = middleOf(triangle) - normal * std::min(4.0 * tolerance_, 0.01 * height);
        int ownFaults = 0, otherFaults = 0;
        for (const glm::dvec3& direction : kProbeDirections) {
            const Winding w = windingAt(triangle, point, direction);
            if (w.own + w.others == 1 && (w.own == 0 || w.own == 1)) return;
            ++(w.others == 0 ? ownFaults : otherFaults);
        }
        if (ownFaults >= 2) within_.report(triangle);
        if (otherFaults >= 2) between_.report(triangle);
    }

    const PlacedShape& placed_;
    TriangleTree tree_;
    std::vector<std::uint32_t> places_;
    double tolerance_ = 0.0;
    FirstFault within_, between_;
};

}  // namespace

std::vector<std::string> checkInterior(const PlacedShape& placed) { return InteriorCheck(placed).run(); }

}  // namespace parhelion
