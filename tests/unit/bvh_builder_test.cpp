#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

#include "unit/bvh_soups.h"

namespace parhelion {
namespace {

using namespace soups;

struct Structure {
    unsigned depth = 0;
    std::vector<int> leafCount;  // how many leaves hold the i-th triangle
    bool boxesHoldTheirTriangles = true;
    bool leavesFit = true;
};

void inspect(const Bvh& bvh, const Soup& soup, int node, unsigned depth, Structure& found) {
    found.depth = std::max(found.depth, depth);
    for (int side = 0; side < 2; ++side) {
        const glm::vec4* texel = &bvh.nodes[std::size_t(node) * shared::kBvhNodeTexels + 2 * side];
        const int child = std::bit_cast<int>(texel[0].w);
        if (child >= 0) {
            inspect(bvh, soup, child, depth + 1, found);
            continue;
        }
        const int first = ~child >> 3, count = ~child & 7;
        found.leavesFit &= count >= 1 && count <= int(shared::kMaxLeafTriangles);
        for (int i = first; i < first + count; ++i) {
            ++found.leafCount.at(i);
            for (const glm::vec3& vertex : soup.triangles[bvh.order[i]])
                found.boxesHoldTheirTriangles &= glm::all(glm::lessThanEqual(glm::vec3(texel[0]), vertex)) &&
                                                 glm::all(glm::greaterThanEqual(glm::vec3(texel[1]), vertex));
        }
    }
}

Structure structureOf(const Bvh& bvh, const Soup& soup) {
    Structure found;
    found.leafCount.assign(soup.triangles.size(), 0);
    inspect(bvh, soup, 0, 1, found);
    return found;
}

double bruteForce(const Soup& soup, const Ray& ray) {
    double closest = kMiss;
    for (const TriangleVertices& triangle : soup.triangles) closest = std::min(closest, intersect(triangle, ray));
    return closest;
}

TEST(BvhBuilder, EveryTriangleIsInOneLeafUnderBoxesThatHoldIt) {
    for (const Soup& soup : allSoups()) {
        const Bvh bvh = buildBvh(soup.triangles);
        const Structure found = structureOf(bvh, soup);
        EXPECT_TRUE(found.boxesHoldTheirTriangles) << soup.name;
        EXPECT_TRUE(found.leavesFit) << soup.name;
        EXPECT_EQ(found.depth, bvh.depth) << soup.name;
        EXPECT_LE(bvh.depth, kMaxBvhDepth) << soup.name;
        // A single triangle hangs from both sides of the root, which must be an inner node.
        const int expected = soup.triangles.size() == 1 ? 2 : 1;
        EXPECT_TRUE(std::ranges::all_of(found.leafCount, [&](int n) { return n == expected; })) << soup.name;
        std::vector<std::uint32_t> order = bvh.order;
        std::ranges::sort(order);
        for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i) << soup.name;
    }
}

TEST(BvhBuilder, ClosestHitsEqualBruteForce) {
    // The same double intersection on both sides: distances are equal to the bit unless a box was missed.
    for (const Soup& soup : allSoups()) {
        const Bvh bvh = buildBvh(soup.triangles);
        int hits = 0, wrong = 0;
        for (const Ray& ray : raysFor(soup, 2000)) {
            const double expected = bruteForce(soup, ray);
            const Visit visit = closestHit(bvh, soup.triangles, ray);
            hits += expected < kMiss;
            wrong += visit.distance != expected;
            ASSERT_LE(visit.deepestStack, shared::kBvhStackSize) << soup.name;
        }
        EXPECT_EQ(wrong, 0) << soup.name;
        EXPECT_GT(hits, 500) << soup.name << ": the rays test nothing";
    }
}

TEST(BvhBuilder, ShrunkenBoxesAreCaught) {
    // The seeded defect: boxes a thousandth too small.
    const Soup soup = randomSoup(2000, 0.1f);
    Bvh bvh = buildBvh(soup.triangles);
    for (std::size_t i = 0; i < bvh.nodes.size(); i += 2) {
        const glm::vec3 middle = 0.5f * (glm::vec3(bvh.nodes[i]) + glm::vec3(bvh.nodes[i + 1]));
        for (std::size_t k = i; k < i + 2; ++k)
            bvh.nodes[k] = glm::vec4(middle + 0.999f * (glm::vec3(bvh.nodes[k]) - middle), bvh.nodes[k].w);
    }
    int wrong = 0;
    for (const Ray& ray : raysFor(soup, 2000))
        wrong += closestHit(bvh, soup.triangles, ray).distance != bruteForce(soup, ray);
    EXPECT_GT(wrong, 0);
}

TEST(BvhBuilder, AHeuristicTreeBeatsHalving) {
    // A good tree over 2000 scattered triangles lets a ray off with a few per cent of the work.
    const Soup soup = randomSoup(2000, 0.05f);
    const Bvh bvh = buildBvh(soup.triangles);
    std::size_t tests = 0, rays = 0;
    for (const Ray& ray : raysFor(soup, 1000)) {
        const Visit visit = closestHit(bvh, soup.triangles, ray);
        tests += visit.boxes + visit.triangles;
        ++rays;
    }
    EXPECT_LT(double(tests) / double(rays), 0.1 * 2000);
}

TEST(BvhBuilder, IsDeterministicAndEmptyForNothing) {
    EXPECT_TRUE(buildBvh({}).nodes.empty());
    const Soup soup = randomSoup(500, 0.2f);
    const Bvh a = buildBvh(soup.triangles), b = buildBvh(soup.triangles);
    EXPECT_EQ(a.order, b.order);
}

TEST(BvhBuilder, DepthIsLimitedWhereTheHeuristicPeelsOneByOne) {
    // Each triangle 19 times smaller than the one before, over the whole range of float: bins see the largest against
    // the rest, and the heuristic alone would go 58 deep.
    Soup soup{"peeling", {}};
    for (int i = 0; i < 60; ++i) {
        const float s = float(std::exp2(120.0 - 4.25 * i));
        soup.triangles.push_back({glm::vec3(s, 0, 0), glm::vec3(s, s, 0), glm::vec3(s, 0, s)});
    }
    const Bvh bvh = buildBvh(soup.triangles);
    const Structure found = structureOf(bvh, soup);
    EXPECT_LE(found.depth, kMaxBvhDepth);
    EXPECT_GT(found.depth, kMaxBvhDepth / 2) << "the soup no longer strains the limit";
    EXPECT_TRUE(found.leavesFit && found.boxesHoldTheirTriangles);
}

TEST(BvhBuilder, SeventyThousandTrianglesTakeUnderHalfASecond) {
    // Processor time, so that other work on the machine does not count.
    const Soup soup = randomSoup(70'000, 0.02f);
    const std::clock_t start = std::clock();
    const Bvh bvh = buildBvh(soup.triangles);
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    RecordProperty("seconds", std::to_string(seconds));
    EXPECT_LT(seconds, 0.5);
    EXPECT_LE(bvh.depth, kMaxBvhDepth);
}

}  // namespace
}  // namespace parhelion
