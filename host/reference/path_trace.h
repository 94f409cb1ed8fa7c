#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shared/path_types.h"

namespace parhelion::reference {

using Counters = std::array<std::uint64_t, shared::kCounterCount>;

/// What happens to a path or to one of its shadow rays.
enum class PathEvent : std::uint32_t {
    Collision,
    NullCollision,
    Surface,
    Boundary,
    Escape,
    ShadowCollision,
    ShadowEnd
};

/// A comparison of a random number with a computed one: where rounding may send two implementations different ways.
struct Decision {
    enum class Kind : std::uint8_t { Flight, ShadowRoulette, PathRoulette } kind;
    std::uint32_t vertex;  ///< scatterings before
    std::uint32_t index;   ///< tentative collision of the ray; 0 for PathRoulette
    std::uint64_t cell;    ///< majorant cell; 0 where there is none
    double uniform;        ///< taken when uniform < probability
    double probability;
};

/// The decisions of one path, for parity tests: two implementations that make the same ones have the same hash, and
/// the difference of their probabilities predicts how often they do not.
struct PathTrace {
    static constexpr bool kIsOn = true;

    std::uint64_t hash = 0xcbf29ce484222325ull;  ///< FNV-1a over the events
    std::vector<Decision> decisions;

    /// @param id  primitive (surface, boundary) or majorant cell (collision).
    void add(PathEvent event, std::uint64_t id) {
        for (const std::uint64_t word : {std::uint64_t(event), id})
            for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (word >> (8 * byte) & 255u)) * 0x100000001b3ull;
    }
    void add(const Decision& decision) { decisions.push_back(decision); }
};

/// Records nothing and costs nothing.
struct NoTrace {
    static constexpr bool kIsOn = false;

    void add(PathEvent, std::uint64_t) {}
    void add(const Decision&) {}
};

}  // namespace parhelion::reference
