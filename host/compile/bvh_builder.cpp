#include "compile/bvh_builder.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <numeric>
#include <optional>

#include "shared/scene_types.h"

namespace parhelion {

namespace {

using shared::kMaxLeafTriangles;

struct Bounds {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void add(const glm::vec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const Bounds& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    /// Half the surface, in double: scenes near the limits of float must not overflow.
    double halfArea() const {
        if (!(lower.x <= upper.x)) return 0.0;
        const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
};

struct Item {
    Bounds bounds;
    glm::vec3 centroid;
    std::uint32_t triangle;
};

struct Split {
    int axis;
    int bin;  ///< bins [0, bin] go left
    double cost;
};

constexpr int kBins = 16;
// In triangle tests: a step down tests two boxes.
constexpr double kStepCost = 2.0;

class Builder {
public:
    explicit Builder(std::span<const TriangleVertices> triangles) {
        items_.reserve(triangles.size());
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            Item item{{}, {}, i};
            for (const glm::vec3& vertex : triangles[i]) item.bounds.add(vertex);
            item.centroid = 0.5f * item.bounds.lower + 0.5f * item.bounds.upper;
            items_.push_back(item);
            for (const glm::vec3& vertex : triangles[i]) largest_ = glm::max(largest_, glm::abs(vertex));
        }
    }

    Bvh build() {
        const std::size_t count = items_.size();
        if (count == 0) return {};
        if (count == 1) {
            // The root must be an inner node: both of its children are the same leaf.
            allocateNode();
            const Bounds bounds = items_.front().bounds;
            writeChild(0, 0, bounds, leaf(0, 1));
            writeChild(0, 1, bounds, leaf(0, 1));
            result_.depth = 1;
        } else {
            buildInner(0, count, chooseMiddle(0, count, 0).value_or(count / 2), 0);
        }
        result_.order.reserve(count);
        for (const Item& item : items_) result_.order.push_back(item.triangle);
        return std::move(result_);
    }

private:
    int allocateNode() {
        const std::size_t node = result_.nodes.size() / shared::kBvhNodeTexels;
        result_.nodes.resize(result_.nodes.size() + shared::kBvhNodeTexels, glm::vec4(0.0f));
        return int(node);
    }

    static int leaf(std::size_t first, std::size_t count) { return ~int((first << 3) | count); }

    /// Slab tests subtract origin / direction from plane / direction, which loses up to 6 roundings of the larger one.
    void writeChild(int node, int side, const Bounds& bounds, int child) {
        const glm::vec3 margin = largest_ * 0x1p-21f;
        glm::vec4* texel = &result_.nodes[std::size_t(node) * shared::kBvhNodeTexels + 2 * side];
        texel[0] = glm::vec4(bounds.lower - margin, std::bit_cast<float>(child));
        texel[1] = glm::vec4(bounds.upper + margin, 0.0f);
    }

    Bounds boundsOf(std::size_t begin, std::size_t end) const {
        Bounds bounds;
        for (std::size_t i = begin; i < end; ++i) bounds.add(items_[i].bounds);
        return bounds;
    }

    int buildInner(std::size_t begin, std::size_t end, std::size_t middle, unsigned depth) {
        result_.depth = std::max(result_.depth, depth + 1);
        const int node = allocateNode();
        const std::array<std::size_t, 3> edges = {begin, middle, end};
        for (int side = 0; side < 2; ++side)
            writeChild(node, side, boundsOf(edges[side], edges[side + 1]),
                       buildChild(edges[side], edges[side + 1], depth + 1));
        return node;
    }

    int buildChild(std::size_t begin, std::size_t end, unsigned depth) {
        const std::optional<std::size_t> middle = chooseMiddle(begin, end, depth);
        return middle ? buildInner(begin, end, *middle, depth) : leaf(begin, end - begin);
    }

    /// Orders items [begin, end) and says where the right child starts; nothing: better as a leaf.
    std::optional<std::size_t> chooseMiddle(std::size_t begin, std::size_t end, unsigned depth) {
        const std::size_t count = end - begin;
        if (count == 1 || depth == kMaxBvhDepth) return std::nullopt;
        Bounds centroids;
        for (std::size_t i = begin; i < end; ++i) centroids.add(items_[i].centroid);

        const std::optional<Split> split = bestSplit(begin, end, centroids);
        const bool fitsLeaf = count <= kMaxLeafTriangles;
        if (fitsLeaf && (!split || split->cost >= double(count))) return std::nullopt;
        if (split) {
            const auto middle = std::partition(items_.begin() + begin, items_.begin() + end, [&](const Item& item) {
                return binOf(item, centroids, split->axis) <= split->bin;
            });
            const std::size_t index = middle - items_.begin();
            if (std::max(index - begin, end - index) <= roomBelow(depth + 1)) return index;
        }
        return halve(begin, end, centroids);
    }

    /// Triangles that fit below a node at `depth` without exceeding the depth limit.
    static std::size_t roomBelow(unsigned depth) {
        return std::size_t(kMaxLeafTriangles) << std::min(kMaxBvhDepth - depth, 40u);
    }

    std::size_t halve(std::size_t begin, std::size_t end, const Bounds& centroids) {
        const glm::vec3 size = centroids.upper - centroids.lower;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const std::size_t middle = begin + (end - begin) / 2;
        std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                         [axis](const Item& a, const Item& b) {
                             return a.centroid[axis] != b.centroid[axis] ? a.centroid[axis] < b.centroid[axis]
                                                                         : a.triangle < b.triangle;
                         });
        return middle;
    }

    static int binOf(const Item& item, const Bounds& centroids, int axis) {
        const double size = double(centroids.upper[axis]) - centroids.lower[axis];
        const double position = (double(item.centroid[axis]) - centroids.lower[axis]) / size;
        return std::min(int(position * kBins), kBins - 1);
    }

    std::optional<Split> bestSplit(std::size_t begin, std::size_t end, const Bounds& centroids) const {
        std::optional<Split> best;
        const double area = boundsOf(begin, end).halfArea();
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centroids.lower[axis] < centroids.upper[axis])) continue;
            std::array<Bounds, kBins> bins;
            std::array<std::size_t, kBins> counts{};
            for (std::size_t i = begin; i < end; ++i) {
                const int bin = binOf(items_[i], centroids, axis);
                bins[bin].add(items_[i].bounds);
                ++counts[bin];
            }
            sweep(bins, counts, area, axis, best);
        }
        return best;
    }

    /// Costs of the 15 planes between bins, in triangle tests for a ray that meets the node.
    static void sweep(const std::array<Bounds, kBins>& bins, const std::array<std::size_t, kBins>& counts, double area,
                      int axis, std::optional<Split>& best) {
        std::array<double, kBins> rightCost{};
        Bounds right;
        std::size_t rightCount = 0;
        for (int bin = kBins - 1; bin > 0; --bin) {
            right.add(bins[bin]);
            rightCount += counts[bin];
            rightCost[bin] = right.halfArea() * double(rightCount);
        }
        Bounds left;
        std::size_t leftCount = 0;
        const std::size_t total = rightCount + counts[0];
        for (int bin = 0; bin + 1 < kBins; ++bin) {
            left.add(bins[bin]);
            leftCount += counts[bin];
            if (leftCount == 0 || leftCount == total) continue;
            const double sum = left.halfArea() * double(leftCount) + rightCost[bin + 1];
            const double cost = kStepCost + (area > 0.0 ? sum / area : double(total));
            if (!best || cost < best->cost) best = Split{axis, bin, cost};
        }
    }

    std::vector<Item> items_;
    glm::vec3 largest_{0.0f};
    Bvh result_;
};

}  // namespace

Bvh buildBvh(std::span<const TriangleVertices> triangles) {
    assert(triangles.size() <= (std::size_t(1) << 28));
    return Builder(triangles).build();
}

}  // namespace parhelion
