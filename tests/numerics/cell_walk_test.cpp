#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "reference/volume/majorant.h"
#include "support/goodness.h"

// Stepping through majorant cells: H25 to H28 of the list of hard cases.
namespace parhelion::reference {
namespace {

struct Grid {
    /// Cells of 8 voxels; a voxel measures `size` world units.
    explicit Grid(glm::ivec3 cells, glm::vec3 size = glm::vec3(1))
        : bounds(std::size_t(cells.x) * cells.y * cells.z, 1) {
        medium.gridFromWorld.linear = glm::mat3(1 / size.x, 0, 0, 0, 1 / size.y, 0, 0, 0, 1 / size.z);
        medium.gridFromWorld.translation = glm::vec3(0);
        medium.resolution = 8 * cells;
        medium.cells = cells;
        medium.majorants = bounds.data();
    }
    std::vector<float> bounds;
    Medium<float> medium{};
};

struct Visit {
    std::vector<glm::ivec3> cells;
    std::vector<float> ends;  ///< t at which each cell is left
};

Visit walkThrough(const Medium<float>& medium, glm::vec3 origin, glm::vec3 direction, float tStart, float tEnd) {
    CellWalk<float> walk = gridRay(medium, origin, direction);
    startCell(medium, tStart, walk);
    Visit visit;
    for (;;) {
        const int axis = nearestAxis(walk);
        const float te = std::max(walk.t, std::min(walk.planes[axis], tEnd));
        visit.cells.push_back(walk.cell);
        visit.ends.push_back(te);
        walk.t = te;
        if (te >= tEnd || visit.cells.size() > 10'000) return visit;
        nextCell(medium, walk, axis);
    }
}

/// Cells along a ray between integer points, in exact integers: planes are compared as fractions. Positions in units of
/// 1/8 voxel, so that a cell is 64 of them; the ray starts and ends within the grid.
std::vector<glm::ivec3> exactCells(glm::ivec3 from, glm::ivec3 to, bool& hasTies) {
    const glm::ivec3 d = to - from;
    glm::ivec3 cell = from / 64;
    std::vector<glm::ivec3> cells{cell};
    for (;;) {
        int best = -1;
        std::int64_t num = 1, den = 1;  // t of the nearest plane, up to 1
        for (int axis = 0; axis < 3; ++axis) {
            if (d[axis] == 0) continue;
            const std::int64_t plane = 64ll * (cell[axis] + (d[axis] > 0 ? 1 : 0));
            std::int64_t n = plane - from[axis], m = d[axis];
            if (m < 0) n = -n, m = -m;
            hasTies |= n * den == num * m && best >= 0;
            if (n * den < num * m) best = axis, num = n, den = m;
        }
        if (best < 0) return cells;
        cell[best] += d[best] > 0 ? 1 : -1;
        cells.push_back(cell);
    }
}

TEST(CellWalk, VisitsWhatExactArithmeticVisits) {  // H26
    constexpr glm::ivec3 kCells{13, 21, 9};
    const Grid grid(kCells);
    std::mt19937 random(1);
    // Odd coordinates: no end lies on a plane.
    const auto point = [&] {
        glm::ivec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = 2 * int(random() % unsigned(32 * kCells[axis])) + 1;
        return p;
    };
    int compared = 0, visits = 0;
    for (int i = 0; i < 20'000; ++i) {
        const glm::ivec3 from = point(), to = point();
        bool hasTies = false;
        const std::vector<glm::ivec3> exact = exactCells(from, to, hasTies);
        if (hasTies) continue;
        // t runs from 0 to 1, positions are exact in float.
        const Visit visit = walkThrough(grid.medium, glm::vec3(from) / 8.0f, glm::vec3(to - from) / 8.0f, 0, 1);
        // Planes within rounding of each other may be crossed in either order: the same number of cells, same ends.
        ASSERT_EQ(visit.cells.size(), exact.size());
        ASSERT_EQ(visit.cells.back(), exact.back());
        int swapped = 0;
        for (std::size_t k = 0; k < exact.size(); ++k) swapped += visit.cells[k] != exact[k];
        visits += int(exact.size());
        compared += swapped;
    }
    EXPECT_GT(visits, 100'000);
    EXPECT_LT(compared, visits / 10'000);
}

TEST(CellWalk, AddingUpStepsWouldDrift) {  // H26: the naive walk adds the distance between planes instead
    constexpr int kCells = 4096;
    const Grid grid({kCells, 1, 1}, glm::vec3(0.1f));
    const Visit visit = walkThrough(grid.medium, {0, 0.4f, 0.4f}, {1, 0, 0}, 0, 0.8f * kCells);
    float added = 0;
    double worst = 0, worstNaive = 0;
    for (int i = 0; i + 1 < kCells; ++i) {
        added += 8 * 0.1f;
        const double exact = (i + 1) * 8 / double(1 / 0.1f);
        worst = std::max(worst, std::abs(visit.ends[std::size_t(i)] / exact - 1));
        worstNaive = std::max(worstNaive, std::abs(double(added) / exact - 1));
    }
    // The inverse direction and the product: two roundings.
    EXPECT_LT(worst, 2 * 0x1p-24);
    EXPECT_GT(worstNaive, 1e-6);
}

TEST(CellWalk, SegmentsFillTheRayHoweverFlatTheVoxels) {  // H25: voxels 1 : 100
    const Grid grid({5, 5, 5}, {1, 0.01f, 100});
    test::IndependentNumbers numbers(2);
    for (int i = 0; i < 10'000; ++i) {
        const auto point = [&] {
            const glm::vec2 a = numbers.pair<float>();
            return glm::vec3(a.x, a.y, numbers.uniform<float>()) * glm::vec3(40, 0.4f, 4000);
        };
        const glm::vec3 from = point(), to = point();
        const float length = glm::length(to - from);
        const Visit visit = walkThrough(grid.medium, from, (to - from) / length, 0, length);
        EXPECT_EQ(visit.ends.back(), length);
        // Three axes of five cells: no more steps than planes.
        EXPECT_LE(visit.cells.size(), 13u);
        double sum = 0;
        float before = 0;
        for (const float end : visit.ends) {
            ASSERT_GE(end, before);
            sum += double(end) - double(before);
            before = end;
        }
        EXPECT_NEAR(sum, length, 1e-6 * length);
    }
}

TEST(CellWalk, AxisParallelRaysTerminateOnEveryPlane) {  // H27
    constexpr int kCells = 4;
    const Grid grid({kCells, kCells, kCells});
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f})
            for (const float y : {-0.0f, 8.0f, 31.999998f, 32.0f})
                for (const float z : {0.0f, 16.0f, 32.0f}) {
                    glm::vec3 origin, direction(0);
                    origin[axis] = side > 0 ? 0.0f : 32.0f;
                    origin[(axis + 1) % 3] = y;
                    origin[(axis + 2) % 3] = z;
                    direction[axis] = side;
                    const Visit visit = walkThrough(grid.medium, origin, direction, 0, 32);
                    ASSERT_EQ(visit.cells.size(), std::size_t(kCells));
                    for (int i = 0; i < kCells; ++i) {
                        EXPECT_EQ(visit.cells[std::size_t(i)][axis], side > 0 ? i : kCells - 1 - i);
                        EXPECT_EQ(visit.ends[std::size_t(i)], 8.0f * float(i + 1));
                    }
                }
    // The naive form multiplies by the reciprocal of 0: (8 - 8) inf.
    EXPECT_TRUE(std::isnan((8.0f - 8.0f) * (1 / std::abs(0.0f))));
}

TEST(CellWalk, CornersAreCrossedInOrderAndBothWaysAlike) {  // H28
    constexpr int kCells = 6;
    Grid grid({kCells, kCells, kCells});
    for (std::size_t i = 0; i < grid.bounds.size(); ++i) grid.bounds[i] = float(i % 7);
    const auto depth = [&](glm::vec3 from, glm::vec3 to) {
        CellWalk<float> walk = gridRay(grid.medium, from, to - from);
        startCell(grid.medium, 0.0f, walk);
        double sum = 0;
        for (int steps = 1;; ++steps) {
            EXPECT_LE(steps, 3 * kCells + 3);
            const int axis = nearestAxis(walk);
            const float te = std::max(walk.t, std::min(walk.planes[axis], 1.0f));
            sum += double(walk.bound) * double(te - walk.t);
            walk.t = te;
            if (te >= 1 || steps > 100) return sum;
            nextCell(grid.medium, walk, axis);
        }
    };
    // Space diagonals, and rays through edges: three and two planes at once.
    for (const glm::vec3 to :
         {glm::vec3(48, 48, 48), glm::vec3(48, 48, 0), glm::vec3(0, 48, 48), glm::vec3(48, 24, 48)})
        for (const glm::vec3 offset : {glm::vec3(0), glm::vec3(0, 0, 1)}) {
            const glm::vec3 a = glm::min(offset, glm::vec3(48)), b = glm::min(to + offset, glm::vec3(48));
            EXPECT_NEAR(depth(a, b), depth(b, a), 1e-5);
        }
}

}  // namespace
}  // namespace parhelion::reference
