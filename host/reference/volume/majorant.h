#pragma once

#include "reference/core/scene.h"

namespace parhelion::reference {

/// A ray on its way through the majorant cells of a medium. Lengths along the ray are the ray's own t.
template <typename Real>
struct CellWalk {
    Vec3<Real> origin, direction, inverse;  ///< in voxel units; direction not unit
    Real t;
    glm::ivec3 cell;
    std::size_t index;  ///< of the cell, x fastest
    Vec3<Real> planes;  ///< t of the next plane along each axis; infinite where the grid ends
    Real bound;         ///< density bound of the cell
};

/// Voxels along an edge of a majorant cell.
/// Reference only: spelt out in the shader.
template <typename Real>
int cellSizeOf(const Medium<Real>& medium) {
    return int(shared::kVoxelsPerCell) << medium.cellLevel;
}

/// The ray in voxel units; where it is in the grid is still to be said.
template <typename Real>
CellWalk<Real> gridRay(const Medium<Real>& medium, const Vec3<Real>& origin, const Vec3<Real>& direction) {
    CellWalk<Real> walk{};
    walk.origin = medium.gridFromWorld.point(origin);
    walk.direction = medium.gridFromWorld.vector(direction);
    walk.inverse = Real(1) / walk.direction;
    return walk;
}

/// Where the walk's ray is inside the grid's box, first distance above the second where it is not: a grid medium ends
/// there, whatever its boundary encloses.
template <typename Real>
Vec2<Real> gridInterval(const Medium<Real>& medium, const CellWalk<Real>& walk) {
    Vec2<Real> interval(-kInfinity<Real>, kInfinity<Real>);
    for (int axis = 0; axis < 3; ++axis) {
        const Real o = walk.origin[axis], size = Real(medium.resolution[axis]);
        if (walk.direction[axis] == 0) {
            if (o < 0 || o > size) return {Real(1), Real(-1)};
            continue;
        }
        const Real a = -o * walk.inverse[axis], b = (size - o) * walk.inverse[axis];
        interval.x = std::max(interval.x, std::min(a, b));
        interval.y = std::min(interval.y, std::max(a, b));
    }
    return interval;
}

/// Puts the walk at distance t of its ray.
template <typename Real>
void startCell(const Medium<Real>& medium, Real t, CellWalk<Real>& walk) {
    walk.t = t;
    const Vec3<Real> cell = glm::floor((walk.origin + t * walk.direction) / Real(cellSizeOf(medium)));
    walk.cell = glm::ivec3(glm::clamp(cell, Vec3<Real>(0), Vec3<Real>(medium.cells - 1)));
    walk.bound = majorantAt(medium, walk);
    planeDistances(medium, walk);
}

/// t of the next plane of one axis, always from the integer cell, so that no error builds up (H26).
/// Infinite where the ray does not move (H27) or would leave the grid: border values extend outwards.
/// Reference only: the shader does all three at once.
template <typename Real>
Real planeDistance(const Medium<Real>& medium, const CellWalk<Real>& walk, int axis) {
    const Real d = walk.direction[axis];
    const int next = walk.cell[axis] + (d > 0 ? 1 : -1);
    if (d == 0 || next < 0 || next >= medium.cells[axis]) return kInfinity<Real>;
    const int plane = cellSizeOf(medium) * (walk.cell[axis] + (d > 0 ? 1 : 0));
    return (Real(plane) - walk.origin[axis]) * walk.inverse[axis];
}

template <typename Real>
void planeDistances(const Medium<Real>& medium, CellWalk<Real>& walk) {
    for (int axis = 0; axis < 3; ++axis) walk.planes[axis] = planeDistance(medium, walk, axis);
}

/// The axis whose plane comes first; x before y before z where they meet.
/// Reference only: within nextCell in the shader.
template <typename Real>
int nearestAxis(const CellWalk<Real>& walk) {
    const Vec3<Real>& t = walk.planes;
    if (t.x <= t.y && t.x <= t.z) return 0;
    return t.y <= t.z ? 1 : 2;
}

/// Steps into the neighbour along an axis whose plane is finite.
template <typename Real>
void nextCell(const Medium<Real>& medium, CellWalk<Real>& walk, int axis) {
    walk.cell[axis] += walk.direction[axis] > 0 ? 1 : -1;
    walk.planes[axis] = planeDistance(medium, walk, axis);
    walk.bound = majorantAt(medium, walk);
}

/// Density bound of the walk's cell; notes the cell's index as well.
template <typename Real>
Real majorantAt(const Medium<Real>& medium, CellWalk<Real>& walk) {
    walk.index = (std::size_t(walk.cell.z) * medium.cells.y + walk.cell.y) * medium.cells.x + walk.cell.x;
    return Real(medium.majorants[walk.index]);
}

}  // namespace parhelion::reference
