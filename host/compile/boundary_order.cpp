#include "compile/boundary_order.h"

#include <fmt/format.h>

#include "base/error.h"

namespace parhelion {

using shared::kNone;

namespace {

/// Shapes that a ray can be inside: null ones, an opaque one that holds the camera, and what is around them.
std::vector<bool> findBoundaries(const CompiledScene& scene) {
    std::vector<bool> found(scene.shapes.size(), false);
    const auto add = [&](std::uint32_t shape) {
        for (; shape < found.size() && !found[shape]; shape = scene.shapes[shape].exterior) found[shape] = true;
    };
    for (std::uint32_t i = 0; i < found.size(); ++i)
        if ((scene.shapes[i].flags & shared::kShapeNull) != 0) add(i);
    add(scene.constants.camera.inside);
    return found;
}

}  // namespace

std::vector<std::uint32_t> orderBoundaries(const CompiledScene& scene) {
    const auto count = std::uint32_t(scene.shapes.size());
    // Boundaries within one are a list: the first in `inner`, each one's next in `sibling`.
    std::vector<std::uint32_t> inner(count, kNone), sibling(count, kNone), bits(count, 0);
    const std::vector<bool> isBoundary = findBoundaries(scene);
    std::uint32_t outermost = kNone;
    for (std::uint32_t i = count; i-- > 0;) {
        if (!isBoundary[i]) continue;
        const std::uint32_t around = scene.shapes[i].exterior;
        std::uint32_t& list = around == kNone ? outermost : inner[around];
        sibling[i] = list;
        list = i;
    }
    // Depth first, without recursion: nesting may be as deep as there are boundaries.
    std::uint32_t number = 0;
    for (std::uint32_t at = outermost; at != kNone;) {
        if (++number > shared::kMaxBoundaries)
            throw RuntimeFailure(fmt::format("a scene may have at most {} medium boundaries", shared::kMaxBoundaries));
        bits[at] = number << shared::kShapeOrderShift;
        std::uint32_t next = inner[at];
        while (next == kNone && at != kNone) {
            bits[at] |= number << shared::kShapeLastShift;
            next = sibling[at];
            at = scene.shapes[at].exterior;
        }
        at = next;
    }
    return bits;
}

}  // namespace parhelion
