#include "compile/star_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <unordered_map>

#include "shared/scene_types.h"

namespace parhelion {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-6;  ///< well above that of float directions

/// Uniform numbers in [0, 1) of a generator that the C++ standard fixes to the bit.
class Uniforms {
public:
    explicit Uniforms(std::uint32_t seed) : engine_(seed) {}
    double next() { return double(engine_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 engine_;
};

/// Arrivals of a process of unit rate within `mean`. Its own loop: the standard leaves its distribution's numbers open.
std::size_t poissonCount(double mean, Uniforms& uniforms) {
    std::size_t count = 0;
    for (double time = -std::log1p(-uniforms.next()); time <= mean && count < shared::kMaxStars; ++count)
        time -= std::log1p(-uniforms.next());
    return count;
}

/// Points on the sphere, hashed by boxes of space, that keep a distance from each other.
class Spacing {
public:
    Spacing(double distance, std::size_t count)
        : distance_(distance), box_(std::max(distance, std::sqrt(4.0 * kPi / double(count + 1)))) {}

    /// Adds the point unless one is nearer than the distance.
    bool add(const glm::dvec3& p) {
        const glm::ivec3 low = boxOf(p - distance_), high = boxOf(p + distance_);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    if (isTaken({x, y, z}, p)) return false;
        points_.emplace(keyOf(boxOf(p)), p);
        return true;
    }

private:
    glm::ivec3 boxOf(const glm::dvec3& p) const { return glm::ivec3(glm::floor((p + 2.0) / box_)); }

    /// At most 2^12 boxes an axis: there are at most 2^18 points.
    static std::uint64_t keyOf(const glm::ivec3& box) {
        return std::uint64_t(box.x) << 40 | std::uint64_t(box.y) << 20 | std::uint64_t(box.z);
    }

    bool isTaken(const glm::ivec3& box, const glm::dvec3& p) const {
        const auto [first, last] = points_.equal_range(keyOf(box));
        return std::any_of(first, last, [&](const auto& other) { return glm::distance(other.second, p) < distance_; });
    }

    double distance_, box_;
    std::unordered_multimap<std::uint64_t, glm::dvec3> points_;
};

glm::dvec3 uniformDirection(Uniforms& uniforms) {
    const double z = 1.0 - 2.0 * uniforms.next(), turn = 2.0 * kPi * uniforms.next();
    const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {sine * std::cos(turn), sine * std::sin(turn), z};
}

/// Inverse of the distribution function of the truncated power law.
double brightnessAt(double u) {
    return kFaintestStar * std::pow(1.0 - u * (1.0 - std::pow(kFaintestStar, 1.5)), -2.0 / 3.0);
}

struct Interval {
    double low, high;
};

/// Cells of one axis of a face that numerator / major may fall into; empty when low > high.
struct CellRange {
    std::uint32_t low, high;
};

/// Bounds of n / m for n and m > 0 in the intervals, as cells.
CellRange cellsOf(const Interval& n, const Interval& m, std::uint32_t cells) {
    const double low = n.low / (n.low < 0 ? m.low : m.high), high = n.high / (n.high < 0 ? m.high : m.low);
    if (low > 1.0 + kRounding || high < -1.0 - kRounding) return {1, 0};
    const auto cellAt = [&](double x) {
        return std::uint32_t(std::clamp((0.5 + 0.5 * x) * cells, 0.0, double(cells) - 1.0));
    };
    return {cellAt(low - kRounding), cellAt(high + kRounding)};
}

/// Calls visit(cell) for every cell that a disc of chord `reach` about `d` may reach.
template <typename Visit>
void forEachCell(const glm::dvec3& d, double reach, std::uint32_t cells, Visit visit) {
    const auto around = [&](double x) { return Interval{x - reach, x + reach}; };
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        Interval major = around(face % 2 == 0 ? d[axis] : -d[axis]);
        // No coordinate of a face's directions is below 1 / sqrt(3) along the face's axis.
        constexpr double kLeastMajor = 0.577;
        if (major.high < kLeastMajor) continue;
        major.low = std::max(major.low, kLeastMajor);
        const CellRange columns = cellsOf(around(d[(axis + 1) % 3]), major, cells);
        const CellRange rows = cellsOf(around(d[(axis + 2) % 3]), major, cells);
        if (columns.low > columns.high) continue;
        for (std::uint32_t row = rows.low; row <= rows.high; ++row)
            for (std::uint32_t column = columns.low; column <= columns.high; ++column)
                visit((std::uint32_t(face) * cells + row) * cells + column);
    }
}

/// Place along the curve of Hilbert over (height, azimuth), which keeps areas: neighbours on it are neighbours in the
/// sky.
std::uint32_t placeOnCurve(const glm::dvec3& d) {
    constexpr std::uint32_t kSide = 1u << 15;
    const auto step = [](double share) { return std::min(std::uint32_t(std::max(share, 0.0) * kSide), kSide - 1); };
    std::uint32_t x = step(0.5 + 0.5 * d.z), y = step(0.5 + std::atan2(d.y, d.x) / (2.0 * kPi)), place = 0;
    for (std::uint32_t half = kSide / 2; half > 0; half /= 2) {
        const std::uint32_t right = (x & half) != 0, upper = (y & half) != 0;
        place = 4 * place + ((3 * right) ^ upper);
        if (upper == 0) {
            if (right == 1) {
                x = kSide - 1 - x;
                y = kSide - 1 - y;
            }
            std::swap(x, y);
        }
    }
    return place;
}

/// Number of stars in each cell.
std::vector<std::uint32_t> countStars(std::span<const Star> stars, double reach, std::uint32_t cells) {
    std::vector<std::uint32_t> counts(std::size_t(6) * cells * cells, 0);
    for (const Star& star : stars)
        forEachCell(star.direction, reach, cells, [&](std::uint32_t cell) { ++counts[cell]; });
    return counts;
}

}  // namespace

double starOneMinusCos(const SkyDescription& sky) {
    const double sine = std::sin(sky.starSizeDegrees * kPi / 720.0);  // of half the radius
    return 2.0 * sine * sine;
}

std::vector<Star> scatterStars(const SkyDescription& sky, const SourceLocation& where) {
    Uniforms uniforms(sky.starSeed);
    const std::size_t count = poissonCount(4.0 * kPi * sky.starDensity, uniforms);
    const double diameter = sky.starSizeDegrees * kPi / 180.0;
    Spacing spacing(2.0 * std::sin(0.5 * diameter) + kRounding, count);
    std::vector<Star> stars;
    stars.reserve(count);
    // Bounds the time whatever the sky is. Where each attempt succeeds with a chance of 0.6, stars are left over with a
    // probability below 1e-300, whatever their number: 2.4 times as many succeed, on average, and 600 more.
    for (std::size_t attempts = 4 * count + 1000; stars.size() < count; --attempts) {
        if (attempts == 0)
            throw InputError(where,
                             fmt::format("sky: {} stars of {} degrees leave no room for each other; found it for "
                                         "{}: fewer or smaller ones fit",
                                         count, sky.starSizeDegrees, stars.size()));
        const glm::vec3 direction(uniformDirection(uniforms));
        if (spacing.add(direction)) stars.push_back({direction, brightnessAt(uniforms.next())});
    }
    std::ranges::stable_sort(stars, {}, [](const Star& star) { return placeOnCurve(star.direction); });
    return stars;
}

StarGrid buildStarGrid(std::span<const Star> stars, double oneMinusCos) {
    StarGrid grid;
    if (stars.empty()) return grid;
    const double reach = std::sqrt(2.0 * oneMinusCos) + kRounding;
    // About one star a cell; finer where some are crowded. Discs keep their distance, so this ends.
    std::uint32_t cells = std::uint32_t(std::ceil(std::sqrt(double(stars.size()) / 6.0)));
    std::vector<std::uint32_t> counts = countStars(stars, reach, cells);
    while (*std::ranges::max_element(counts) > shared::kMaxStarsPerCell) {
        cells += cells / 2 + 1;
        counts = countStars(stars, reach, cells);
    }
    grid.cellsPerEdge = cells;
    auto first = std::uint32_t(counts.size());
    for (const std::uint32_t count : counts) {
        grid.words.push_back(first << 4);
        first += count;
    }
    grid.words.resize(first);
    for (std::uint32_t star = 0; star < stars.size(); ++star)
        forEachCell(stars[star].direction, reach, cells, [&](std::uint32_t cell) {
            const std::uint32_t word = grid.words[cell]++;  // the low bits count
            grid.words[(word >> 4) + (word & 15u)] = star;
        });
    return grid;
}

}  // namespace parhelion
