#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "compile/placed_shape.h"
#include "compile/triangle_tree.h"

namespace parhelion {

/// How the insides of two boundaries of media lie.
enum class Relation { Apart, Within, Around, Overlap };  ///< the first in relation to the second

/// Finds how boundaries lie to one another: spheres, boxes and closed meshes, by one rule. Those that touch, share
/// faces or overlap by less than 1e-6 of their size are apart, or one within the other.
///
/// Of meshes (and of boxes against meshes) no two triangles may pierce each other, and the points just within all
/// triangles of one must be inside the other, or none on either side. Opaque meshes need not be closed: of those the
/// bounds decide, which takes a mesh that reaches beyond them for one that is apart.
class BoundaryRelations {
public:
    explicit BoundaryRelations(std::span<const PlacedShape> shapes) : shapes_(shapes) {}

    Relation between(std::size_t a, std::size_t b) const;
    /// A point where two boundaries that overlap do [scene space]; none for two solids, whose formulas give none.
    std::optional<glm::dvec3> overlapOf(std::size_t a, std::size_t b) const;

private:
    struct Finding {
        Relation relation = Relation::Apart;
        std::optional<glm::dvec3> where;
    };

    const Finding& findingOf(std::size_t a, std::size_t b) const;
    Finding find(std::size_t a, std::size_t b) const;
    Finding compareSurfaces(std::size_t a, std::size_t b, double tolerance) const;
    Finding compareWithSphere(std::size_t mesh, std::size_t sphere, double tolerance) const;
    const TriangleTree& treeOf(std::size_t shape) const;

    std::span<const PlacedShape> shapes_;
    mutable std::map<std::size_t, std::unique_ptr<TriangleTree>> trees_;       ///< made when first asked for
    mutable std::map<std::pair<std::size_t, std::size_t>, Finding> findings_;  ///< the same
};

}  // namespace parhelion
