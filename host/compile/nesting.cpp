#include "compile/nesting.h"

#include <fmt/format.h>

#include <cmath>

#include "compile/boundary_relations.h"
#include "compile/containment.h"
#include "shared/scene_types.h"

namespace parhelion {

namespace {

std::string nameOfMedium(std::span<const MediumDescription> media, std::optional<std::size_t> index) {
    return index ? fmt::format("\"{}\"", media[*index].id) : std::string("no medium");
}

std::string nameAndPlace(const PlacedShape& shape) {
    return fmt::format("{} ({})", nameOf(*shape.source), shape.source->where.text());
}

/// Rays change medium at null surfaces only, so an opaque shape's interior matters when the camera is in it.
bool boundsMedium(const PlacedShape& shape) {
    if (shape.isNull()) return shape.mentionsMedia();
    return shape.source->interior && containsPoint(shape, glm::dvec3(0.0));
}

class NestingResolver {
public:
    NestingResolver(std::span<const PlacedShape> shapes, std::span<const MediumDescription> media)
        : shapes_(shapes), media_(media), relations_(shapes) {
        for (std::size_t i = 0; i < shapes.size(); ++i)
            if (boundsMedium(shapes[i])) boundaries_.push_back(i);
        if (boundaries_.size() > shared::kMaxBoundaries)
            throw InputError(shapes[boundaries_[shared::kMaxBoundaries]].source->where,
                             fmt::format("a scene may have at most {} medium boundaries; got {}",
                                         shared::kMaxBoundaries, boundaries_.size()));
    }

    Nesting resolve() const {
        Nesting nesting;
        nesting.isBoundary.resize(shapes_.size(), false);
        nesting.surrounding.resize(shapes_.size());
        for (const std::size_t i : boundaries_) nesting.isBoundary[i] = true;
        rejectOverlaps();
        for (const std::size_t i : boundaries_) nesting.surrounding[i] = surroundingOf(i);
        for (std::size_t i = 0; i < shapes_.size(); ++i)
            if (!shapes_[i].isNull()) requireProvider(i);
        for (const std::size_t i : boundaries_)
            if (containsPoint(shapes_[i], glm::dvec3(0.0)) && isSmaller(i, nesting.camera)) nesting.camera = i;
        return nesting;
    }

private:
    /// A strict order in which whatever lies within something comes before it.
    bool isSmaller(std::size_t i, std::optional<std::size_t> than) const {
        if (!than) return true;
        const double a = std::abs(shapes_[i].volume), b = std::abs(shapes_[*than].volume);
        return a < b || (a == b && i < *than);
    }

    void rejectOverlaps() const {
        for (std::size_t i = 0; i < boundaries_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const std::size_t a = boundaries_[i], b = boundaries_[j];
                if (relations_.between(a, b) != Relation::Overlap) continue;
                throw InputError(
                    shapes_[a].source->where,
                    fmt::format("{}: media must be apart or one inside the other; it overlaps {}{}",
                                nameOf(*shapes_[a].source), nameAndPlace(shapes_[b]), placeOfOverlap(a, b)));
            }
    }

    std::string placeOfOverlap(std::size_t a, std::size_t b) const {
        const std::optional<glm::dvec3> where = relations_.overlapOf(a, b);
        if (!where) return {};
        const glm::dvec3 origin = glm::dvec3(shapes_[a].source->toWorld[3]) - glm::dvec3(shapes_[a].toScene[3]);
        const glm::dvec3 p = *where + origin;
        return fmt::format(", near ({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
    }

    /// The smallest shape around `inner` among those that `accept` takes.
    template <typename Predicate>
    std::optional<std::size_t> innermostAround(std::size_t inner, Predicate accept) const {
        std::optional<std::size_t> best;
        for (const std::size_t i : boundaries_)
            if (isSmaller(inner, i) && accept(shapes_[i]) && isSmaller(i, best) &&
                relations_.between(inner, i) == Relation::Within)
                best = i;
        return best;
    }

    std::optional<std::size_t> surroundingOf(std::size_t inner) const {
        const PlacedShape& shape = shapes_[inner];
        const std::optional<std::size_t> wanted = shape.source->exterior;
        const auto certain = innermostAround(
            inner, [](const PlacedShape& outer) { return outer.isAnalyticSolid() || outer.isMediumMesh(); });
        if (!wanted) {
            if (certain && shapes_[*certain].source->interior) failWithHint(shape, shapes_[*certain]);
            return certain;
        }
        const auto provider =
            innermostAround(inner, [&](const PlacedShape& outer) { return outer.source->interior == wanted; });
        if (provider && (!certain || !isSmaller(*certain, provider))) return provider;
        if (certain) failWithHint(shape, shapes_[*certain]);
        throw unbounded(shape);
    }

    [[noreturn]] void failWithHint(const PlacedShape& inner, const PlacedShape& outer) const {
        const std::string hint = outer.source->interior ? fmt::format("give it `<ref name=\"exterior\" id={}/>`",
                                                                      nameOfMedium(media_, outer.source->interior))
                                                        : std::string("remove its `exterior`");
        throw InputError(inner.source->where,
                         fmt::format("{}: `exterior` must name the medium around it, {} of {}; got {}; {}",
                                     nameOf(*inner.source), nameOfMedium(media_, outer.source->interior),
                                     nameAndPlace(outer), nameOfMedium(media_, inner.source->exterior), hint));
    }

    InputError unbounded(const PlacedShape& shape) const {
        return InputError(shape.source->where,
                          fmt::format("{}: no shape around it has the `exterior` medium {} as its interior; unbounded "
                                      "media are not supported",
                                      nameOf(*shape.source), nameOfMedium(media_, shape.source->exterior)));
    }

    /// Opaque shapes may cut through a boundary (a floor under fog), so it is enough that their medium exists.
    void requireProvider(std::size_t opaque) const {
        const std::optional<std::size_t> wanted = shapes_[opaque].source->exterior;
        if (!wanted) return;
        for (const std::size_t i : boundaries_)
            if (shapes_[i].source->interior == wanted) return;
        throw unbounded(shapes_[opaque]);
    }

    std::span<const PlacedShape> shapes_;
    std::span<const MediumDescription> media_;
    std::vector<std::size_t> boundaries_;
    BoundaryRelations relations_;
};

}  // namespace

Nesting resolveNesting(std::span<const PlacedShape> shapes, std::span<const MediumDescription> media) {
    return NestingResolver(shapes, media).resolve();
}

void checkCameraMedium(const SceneDescription& description, std::span<const PlacedShape> shapes,
                       const Nesting& nesting) {
    const CameraDescription& camera = description.camera;
    if (!camera.medium) return;
    const std::optional<std::size_t> around = nesting.camera ? shapes[*nesting.camera].source->interior : std::nullopt;
    if (around == camera.medium) return;
    throw InputError(camera.mediumWhere,
                     fmt::format("the sensor's medium must be the one around it, {}{}; got {}",
                                 nameOfMedium(description.media, around),
                                 nesting.camera ? " of " + nameAndPlace(shapes[*nesting.camera]) : std::string(),
                                 nameOfMedium(description.media, camera.medium)));
}

}  // namespace parhelion
