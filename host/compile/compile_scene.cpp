#include "compile/compile_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <functional>

#include "base/memory.h"
#include "compile/compile_film.h"
#include "compile/compile_geometry.h"
#include "compile/compile_lights.h"
#include "compile/compile_media.h"
#include "compile/compile_textures.h"
#include "compile/extinction_grid.h"
#include "compile/medium_extent.h"
#include "compile/nesting.h"

namespace parhelion {

namespace {

/// Only the ratio of the strategies matters; a path takes one sample of each.
void compileStrategies(const IntegratorDescription& integrator, const CompileOptions& options, CompiledScene& scene) {
    const double larger = std::max(integrator.emitterSamples, integrator.scatterSamples);
    scene.constants.emitterSamples = float(integrator.emitterSamples / larger);
    scene.constants.scatterSamples = float(integrator.scatterSamples / larger);
    if (integrator.type == "direct" && options.maxDepth && (*options.maxDepth < 0 || *options.maxDepth > 2))
        throw InputError(fmt::format(
            "max_depth must be 0, 1 or 2: the scene asks for direct lighting (integrator \"direct\"); got {}",
            *options.maxDepth));
}

void compileIntegrator(const SceneDescription& description, const CompileOptions& options, CompiledScene& scene) {
    const std::int64_t depth = options.maxDepth.value_or(description.integrator.maxDepth);
    const std::string message = fmt::format("max_depth must be -1 (unlimited) or >= 0; got {}", depth);
    if (depth < -1 && options.maxDepth) throw InputError(message);
    const SourceLocation file{description.file.string()};
    if (depth < -1) throw InputError(file, "integrator: " + message);
    if (description.integrator.rouletteDepth < 0)
        throw InputError(
            file, fmt::format("integrator: rr_depth must be >= 0; got {}", description.integrator.rouletteDepth));
    // No path reaches 2^32 - 1 vertices: beyond it, every limit is none.
    constexpr std::int64_t kUnlimited = shared::kNone;
    scene.constants.maxDepth = depth < 0 ? shared::kNone : std::uint32_t(std::min(depth, kUnlimited));
    scene.constants.rouletteDepth = std::uint32_t(std::min(description.integrator.rouletteDepth, kUnlimited));
    compileStrategies(description.integrator, options, scene);
    scene.constants.depthLayers = options.depthLayers.value_or(description.integrator.depthLayers);
    scene.sampleCount = description.sampleCount;
    scene.seed = description.seed;
}

/// Decides which shapes and media remain, and numbers them.
class Selection {
public:
    Selection(const SceneDescription& description, std::span<const PlacedShape> shapes, CompiledScene& scene)
        : shapes_(shapes),
          nesting_(resolveNesting(shapes, description.media)),
          emptyMedia_(findEmptyMedia(description, scene.notes)),
          shapeIndex_(shapes.size(), shared::kNone),
          mediumIndex_(description.media.size(), shared::kNone) {
        checkCameraMedium(description, shapes, nesting_);
        ignoreMediaOfSurfaceIntegrator(description, scene);
        for (std::size_t i = 0; i < shapes.size(); ++i)
            if (isKept(i)) shapeIndex_[i] = count_++;
        noteDropped(scene);
        for (std::size_t i = 0; i < shapes.size(); ++i)
            if (shapeIndex_[i] != shared::kNone) keep(i, description);
        clipMedia(scene);
        scene.constants.camera.inside = keptOrAround(nesting_.camera);
    }

    std::span<KeptShape> shapes() { return kept_; }
    std::span<const MediumDescription* const> media() const { return media_; }

private:
    /// Mitsuba's `path` and `direct` integrators see surfaces only.
    void ignoreMediaOfSurfaceIntegrator(const SceneDescription& description, CompiledScene& scene) {
        const std::string& type = description.integrator.type;
        if (type == "volpath" || std::ranges::all_of(emptyMedia_, std::identity{})) return;
        scene.notes.push_back(
            fmt::format("the {} integrator ignores participating media; volpath simulates them", type));
        emptyMedia_.assign(emptyMedia_.size(), true);
    }

    /// The medium behind a boundary, if there is anything of it.
    std::optional<std::size_t> mediumIn(std::optional<std::size_t> boundary) const {
        if (!boundary) return std::nullopt;
        const std::optional<std::size_t> medium = shapes_[*boundary].source->interior;
        return medium && !emptyMedia_[*medium] ? medium : std::nullopt;
    }

    bool isKept(std::size_t i) const {
        const PlacedShape& shape = shapes_[i];
        if (shape.kind == PlacedShape::Kind::Mesh && shape.source->mesh.triangles.empty()) return false;
        return !shape.isNull() || mediumIn(i) || mediumIn(nesting_.surrounding[i]);
    }

    void noteDropped(CompiledScene& scene) const {
        std::size_t dropped = 0, unreachable = 0;
        for (std::size_t i = 0; i < shapes_.size(); ++i) {
            dropped += shapeIndex_[i] == shared::kNone;
            unreachable += !nesting_.isBoundary[i] && shapes_[i].source->interior.has_value();
        }
        if (dropped > 0) scene.notes.push_back(fmt::format("{} shapes that change nothing were dropped", dropped));
        if (unreachable > 0)
            scene.notes.push_back(
                fmt::format("{} opaque shapes have interior media that no path reaches", unreachable));
    }

    /// A dropped boundary has the same on both sides: what is around it.
    std::uint32_t keptOrAround(std::optional<std::size_t> boundary) const {
        while (boundary && shapeIndex_[*boundary] == shared::kNone) boundary = nesting_.surrounding[*boundary];
        return boundary ? shapeIndex_[*boundary] : shared::kNone;
    }

    void keep(std::size_t i, const SceneDescription& description) {
        KeptShape kept;
        kept.placed = &shapes_[i];
        kept.exterior = keptOrAround(nesting_.surrounding[i]);
        if (const auto medium = mediumIn(i); medium && nesting_.isBoundary[i]) {
            if (mediumIndex_[*medium] == shared::kNone) {
                mediumIndex_[*medium] = std::uint32_t(media_.size());
                media_.push_back(&description.media[*medium]);
            }
            kept.interior = mediumIndex_[*medium];
        }
        kept_.push_back(kept);
    }

    void clipMedia(CompiledScene& scene) {
        for (std::uint32_t medium = 0; medium < media_.size(); ++medium) {
            std::vector<const PlacedShape*> boundaries;
            for (const KeptShape& shape : kept_)
                if (shape.interior == medium) boundaries.push_back(shape.placed);
            if (auto clipped = clipToExtent(*media_[medium], boundaries, scene.worldOrigin, scene.notes))
                media_[medium] = &clipped_.emplace_back(std::move(*clipped));
        }
    }

    std::span<const PlacedShape> shapes_;
    Nesting nesting_;
    std::vector<bool> emptyMedia_;
    std::vector<std::uint32_t> shapeIndex_;   ///< by placed shape
    std::vector<std::uint32_t> mediumIndex_;  ///< by medium of the description
    std::uint32_t count_ = 0;
    std::vector<KeptShape> kept_;
    std::vector<const MediumDescription*> media_;
    std::deque<MediumDescription> clipped_;  ///< those of media_ that are not the description's
};

/// Notes media in which positions are too coarse to scatter about.
///
/// Positions are floats about the camera, u = 2^-23 D apart at the largest coordinate D. Rounding adds u^2 / 12 to the
/// variance along each axis of a free flight of mean l, which is 2 l^2 / 3: a share of u^2 / (8 l^2), 0.2 % at l = 8 u.
/// At a surface it shows a little more: measured there, the albedo of a half-space is off by 0.5 %.
void noteCoarsePositions(Selection& selection, CompiledScene& scene) {
    for (const KeptShape& shape : selection.shapes()) {
        if (shape.interior == shared::kNone) continue;
        const MediumDescription& medium = *selection.media()[shape.interior];
        const glm::dvec3 farthest = glm::max(glm::abs(shape.placed->lower), glm::abs(shape.placed->upper));
        const double spacing = 0x1p-23 * std::max({farthest.x, farthest.y, farthest.z});
        const double density = medium.density ? largestValue(medium.density->volume) : 1.0;
        const double meanFreePath = 1.0 / (scene.constants.media[shape.interior].sigmaMax * density);
        if (meanFreePath >= 8.0 * spacing) continue;
        scene.notes.push_back(fmt::format(
            "medium {}in {}: its mean free path, {:.3g}, should be 8 times the distance between neighbouring positions "
            "in single precision, {:.3g} where it is farthest from the camera: scattering there is biased "
            "(--backend reference-double is exact)",
            medium.id.empty() ? "" : fmt::format("\"{}\" ", medium.id), nameOf(*shape.placed->source), meanFreePath,
            spacing));
    }
}

}  // namespace

CompiledScene compileScene(const SceneDescription& description, const CompileOptions& options) {
    const std::size_t limit = options.memoryLimitBytes ? options.memoryLimitBytes : physicalMemoryBytes() / 2;
    CompiledScene scene;
    scene.notes = description.notes;
    compileFilm(description, options, scene);
    compileCamera(description, scene);
    compileIntegrator(description, options, scene);

    std::vector<PlacedShape> placed;
    placed.reserve(description.shapes.size());
    for (const ShapeDescription& shape : description.shapes) placed.push_back(placeShape(shape, scene.worldOrigin));
    for (const PlacedShape& shape : placed)
        scene.notes.insert(scene.notes.end(), shape.notes.begin(), shape.notes.end());
    Selection selection(description, placed, scene);
    compileMedia(selection.media(), scene.worldOrigin, limit, scene);
    compileTextures(description, selection.shapes(), scene);
    const std::vector<EmissiveGeometry> emissive = compileGeometry(selection.shapes(), scene);
    noteCoarsePositions(selection, scene);
    compileLights(description, selection.shapes(), emissive, options.sampleEveryLight, scene);
    const std::size_t inlined = std::min<std::size_t>(scene.shapes.size(), shared::kMaxInlineShapes);
    std::copy_n(scene.shapes.begin(), inlined, scene.constants.shapes);

    if (scene.memoryBytes() > limit)
        throw RuntimeFailure(
            fmt::format("the compiled scene needs {} bytes; allowed are {}", scene.memoryBytes(), limit));
    scene.effects = analyseEffects(scene);
    return scene;
}

}  // namespace parhelion
