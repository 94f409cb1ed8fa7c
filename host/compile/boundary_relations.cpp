#include "compile/boundary_relations.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "compile/containment.h"
#include "compile/triangle_overlap.h"

namespace parhelion {

namespace {

using Kind = PlacedShape::Kind;

/// The two relations that containment.h gives.
Relation relationOf(const PlacedShape& a, const PlacedShape& b) {
    if (areApart(a, b)) return Relation::Apart;
    const bool within = encloses(b, a), around = encloses(a, b);
    if (within == around) return Relation::Overlap;
    return within ? Relation::Within : Relation::Around;
}

void lower(std::atomic<std::uint32_t>& least, std::uint32_t value) {
    std::uint32_t before = least;
    while (value < before && !least.compare_exchange_weak(before, value)) {
    }
}

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// A triangle of `a` that pierces one of `b`, the lowest; kNobody if there is none.
std::pair<std::uint32_t, std::uint32_t> findPiercing(const TriangleTree& a, const TriangleTree& b, double tolerance) {
    std::atomic<std::uint32_t> first{kNobody};
    const auto partner = [&](std::size_t i) {
        const Corners& t = a.triangles()[i];
        std::uint32_t found = kNobody;
        b.visitBox(glm::min(glm::min(t[0], t[1]), t[2]), glm::max(glm::max(t[0], t[1]), t[2]), [&](std::uint32_t j) {
            if (j < found && pierce(t, b.triangles()[j], tolerance)) found = j;
        });
        return found;
    };
    parallelFor(
        a.triangles().size(),
        [&](std::size_t i) {
            if (i < first && partner(i) != kNobody) lower(first, std::uint32_t(i));
        },
        64);
    return {first, first == kNobody ? kNobody : partner(first)};
}

/// How many of the points just within a surface are inside another one.
struct Skin {
    std::uint32_t firstInside = kNobody, firstOutside = kNobody;  ///< triangles

    bool isInside() const { return firstOutside == kNobody; }
    bool isOutside() const { return firstInside == kNobody; }
};

glm::dvec3 pointWithin(const Corners& t, double depth) { return (t[0] + t[1] + t[2]) / 3.0 - unitNormal(t) * depth; }

Skin skinOf(const TriangleTree& surface, const TriangleTree& other, double depth) {
    std::atomic<std::uint32_t> inside{kNobody}, outside{kNobody};
    parallelFor(
        surface.triangles().size(),
        [&](std::size_t i) {
            const Corners& t = surface.triangles()[i];
            if (unitNormal(t) == glm::dvec3(0.0)) return;
            lower(surrounds(other, pointWithin(t, depth)) ? inside : outside, std::uint32_t(i));
        },
        64);
    return {inside, outside};
}

}  // namespace

const TriangleTree& BoundaryRelations::treeOf(std::size_t shape) const {
    std::unique_ptr<TriangleTree>& tree = trees_[shape];
    if (!tree) tree = std::make_unique<TriangleTree>(surfaceOf(shapes_[shape]));
    return *tree;
}

BoundaryRelations::Finding BoundaryRelations::compareSurfaces(std::size_t a, std::size_t b, double tolerance) const {
    const TriangleTree &p = treeOf(a), &q = treeOf(b);
    if (const auto [i, j] = findPiercing(p, q, tolerance); i != kNobody)
        return {Relation::Overlap, piercedPoint(p.triangles()[i], q.triangles()[j])};
    // Beyond faces that coincide within the tolerance.
    const double depth = 4.0 * tolerance;
    const Skin ofP = skinOf(p, q, depth), ofQ = skinOf(q, p, depth);
    if (ofP.isInside() != ofQ.isInside()) return {ofP.isInside() ? Relation::Within : Relation::Around, {}};
    if (ofP.isOutside() && ofQ.isOutside()) return {Relation::Apart, {}};
    if (!ofP.isOutside()) return {Relation::Overlap, pointWithin(p.triangles()[ofP.firstInside], depth)};
    return {Relation::Overlap, pointWithin(q.triangles()[ofQ.firstInside], depth)};
}

/// A closed part of a mesh crosses the sphere if some of it is nearer to the centre than the radius and some farther.
BoundaryRelations::Finding BoundaryRelations::compareWithSphere(std::size_t mesh, std::size_t sphere,
                                                                double tolerance) const {
    const PlacedShape &shape = shapes_[mesh], &ball = shapes_[sphere];
    const TriangleTree& tree = treeOf(mesh);
    const std::size_t parts = 1 + *std::ranges::max_element(shape.parts);
    std::vector<double> nearest(parts, std::numeric_limits<double>::infinity()), farthest(parts, 0.0);
    std::vector<std::uint32_t> nearestTriangle(parts, 0);
    for (std::uint32_t i = 0; i < tree.triangles().size(); ++i) {
        const Corners& t = tree.triangles()[i];
        const std::uint32_t part = shape.parts[i];
        const double distance = distanceTo(t, ball.center);
        if (distance < nearest[part]) nearestTriangle[part] = i;
        nearest[part] = std::min(nearest[part], distance);
        for (const glm::dvec3& corner : t)
            farthest[part] = std::max(farthest[part], glm::distance(corner, ball.center));
    }
    std::size_t inside = 0, first = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        const bool isInside = farthest[part] <= ball.radius + tolerance;
        if (!isInside && nearest[part] < ball.radius - tolerance)
            return {Relation::Overlap, pointWithin(tree.triangles()[nearestTriangle[part]], 0.0)};
        if (isInside && inside++ == 0) first = part;
    }
    if (inside == parts) return {Relation::Within, {}};
    // The sphere's own surface lies on one side of the mesh: any of its points tells on which.
    const glm::dvec3 skin = ball.center + (ball.radius - 4.0 * tolerance) * glm::normalize(kProbeDirections[0]);
    const bool around = surrounds(tree, skin);
    if (inside == 0) return {around ? Relation::Around : Relation::Apart, {}};
    return {Relation::Overlap, pointWithin(tree.triangles()[nearestTriangle[first]], 0.0)};
}

BoundaryRelations::Finding BoundaryRelations::find(std::size_t a, std::size_t b) const {
    const PlacedShape &p = shapes_[a], &q = shapes_[b];
    if (p.isAnalyticSolid() && q.isAnalyticSolid()) return {relationOf(p, q), {}};
    const auto isOpaqueMesh = [](const PlacedShape& s) { return s.kind == Kind::Mesh && !s.isMediumMesh(); };
    if (isOpaqueMesh(p) && encloses(p, q)) return {Relation::Around, {}};
    if (isOpaqueMesh(q) && encloses(q, p)) return {Relation::Within, {}};
    if (isOpaqueMesh(p) || isOpaqueMesh(q)) return {};
    if (areApart(p, q)) return {};
    const glm::dvec3 size = glm::max(p.upper - p.lower, q.upper - q.lower);
    const double tolerance = 1e-6 * std::max({size.x, size.y, size.z});
    if (q.kind == Kind::Sphere) return compareWithSphere(a, b, tolerance);
    if (p.kind != Kind::Sphere) return compareSurfaces(a, b, tolerance);
    Finding finding = compareWithSphere(b, a, tolerance);
    if (finding.relation == Relation::Within || finding.relation == Relation::Around)
        finding.relation = finding.relation == Relation::Within ? Relation::Around : Relation::Within;
    return finding;
}

const BoundaryRelations::Finding& BoundaryRelations::findingOf(std::size_t a, std::size_t b) const {
    const auto [found, isNew] = findings_.try_emplace({a, b});
    if (isNew) found->second = find(a, b);
    return found->second;
}

Relation BoundaryRelations::between(std::size_t a, std::size_t b) const {
    if (a <= b) return findingOf(a, b).relation;
    const Relation relation = findingOf(b, a).relation;
    if (relation == Relation::Within) return Relation::Around;
    return relation == Relation::Around ? Relation::Within : relation;
}

std::optional<glm::dvec3> BoundaryRelations::overlapOf(std::size_t a, std::size_t b) const {
    return findingOf(std::min(a, b), std::max(a, b)).where;
}

}  // namespace parhelion
