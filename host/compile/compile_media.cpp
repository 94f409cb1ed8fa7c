#include "compile/compile_media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "compile/compile_phase.h"
#include "compile/density_storage.h"
#include "compile/extinction_grid.h"
#include "compile/majorant_grid.h"
#include "compile/transforms.h"

namespace parhelion {

namespace {

std::string nameOf(const MediumDescription& medium) {
    return medium.id.empty() ? std::string("medium") : fmt::format("medium \"{}\"", medium.id);
}

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// world -> voxel units of a grid under `placement`: [0, resolution].
glm::mat4x3 voxelsFromScene(const GridPlacement& placement, glm::uvec3 resolution, const glm::dvec3& worldOrigin,
                            const std::string& subject) {
    requireInvertible(placement.toWorld, placement.where, subject);
    const glm::dmat4 localFromScene = glm::inverse(relativeTo(placement.toWorld, worldOrigin));
    return toFloat(glm::scale(glm::dmat4(1.0), glm::dvec3(resolution)) * localFromScene, placement.where,
                   subject + ": inverse of to_world");
}

void writeExtinction(const MediumDescription& medium, shared::Medium& record) {
    const glm::vec3 sigmaT = toFloat(medium.sigmaT, medium.where, nameOf(medium) + ": sigma_t");
    record.sigmaMax = std::max({sigmaT.x, sigmaT.y, sigmaT.z});
    for (int c = 0; c < 3; ++c) record.sigmaRatio[c] = float(medium.sigmaT[c] / largest(medium.sigmaT));
}

void checkAlbedo(const glm::dvec3& albedo, const SourceLocation& where, const std::string& subject) {
    for (int c = 0; c < 3; ++c)
        if (!(albedo[c] >= 0.0 && albedo[c] <= 1.0))
            throw InputError(where, fmt::format("{}: albedo must be in [0, 1]; got {}", subject, albedo[c]));
}

glm::uvec3 resolutionOf(const Volume& volume) {
    return volume.channels == 3 ? volume.color.resolution : volume.density.resolution();
}

std::size_t texelCount(const GridPlacement& placement) {
    const glm::uvec3 n = resolutionOf(placement.volume);
    return std::size_t(n.x) * n.y * n.z;
}

std::vector<glm::vec4> albedoTexels(const Volume& volume) {
    std::vector<glm::vec4> texels;
    if (volume.channels == 3) {
        for (std::size_t i = 0; i + 2 < volume.color.values.size(); i += 3)
            texels.emplace_back(volume.color.values[i], volume.color.values[i + 1], volume.color.values[i + 2], 0.0f);
    } else {
        for (const float value : volume.density.toDense()) texels.emplace_back(value, value, value, 0.0f);
    }
    return texels;
}

/// A grid with the same albedo everywhere becomes that albedo.
void writeAlbedo(const MediumDescription& medium, const glm::dvec3& worldOrigin, shared::Medium& record,
                 CompiledScene& scene) {
    if (!medium.albedoGrid) {
        checkAlbedo(medium.albedo, medium.where, nameOf(medium));
        record.albedo = glm::vec3(medium.albedo);
        return;
    }
    const std::vector<glm::vec4> texels = albedoTexels(medium.albedoGrid->volume);
    for (const glm::vec4& texel : texels) checkAlbedo(glm::dvec3(texel), medium.albedoGrid->where, nameOf(medium));
    const auto differs = [&](const glm::vec4& texel) { return texel != texels.front(); };
    if (std::ranges::none_of(texels, differs)) {
        record.albedo = glm::vec3(texels.front());
        return;
    }
    record.albedo = glm::vec3(1.0f);
    record.flags |= shared::kMediumAlbedoGrid;
    record.albedoResolution = resolutionOf(medium.albedoGrid->volume);
    record.albedoFromWorld =
        voxelsFromScene(*medium.albedoGrid, record.albedoResolution, worldOrigin, nameOf(medium) + ": albedo");
    record.albedoOffset = std::uint32_t(scene.albedoVoxels.size());
    scene.albedoVoxels.insert(scene.albedoVoxels.end(), texels.begin(), texels.end());
}

/// Lengths of a voxel's edges [scene units].
glm::dvec3 voxelEdges(const GridPlacement& placement, glm::uvec3 resolution) {
    const glm::dmat4& axes = placement.toWorld;
    return glm::dvec3(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])) / glm::dvec3(resolution);
}

void writeDensity(const MediumDescription& medium, const ExtinctionGrid* extinction, const glm::dvec3& worldOrigin,
                  bool bricked, shared::Medium& record, CompiledScene& scene) {
    if (!extinction) {
        record.flags |= shared::kMediumHomogeneous;
        record.resolution = record.cells = glm::uvec3(1);
        return;
    }
    const DensityGrid& grid = extinction->largest();
    const MajorantGrid majorants =
        chooseMajorants(grid, double(record.sigmaMax) * voxelEdges(*medium.density, grid.resolution()));
    if (!std::isfinite(record.sigmaMax * *std::ranges::max_element(majorants.bounds)))
        throw InputError(medium.density->where, nameOf(medium) +
                                                    ": sigma_t times the largest density must be within "
                                                    "the range of single precision (3.4e38)");
    record.resolution = grid.resolution();
    record.gridFromWorld =
        voxelsFromScene(*medium.density, record.resolution, worldOrigin, nameOf(medium) + ": sigma_t");
    record.cells = majorants.cells;
    record.cellLevel = majorants.level;
    record.cellOffset = std::uint32_t(scene.majorants.size());
    scene.majorants.insert(scene.majorants.end(), majorants.bounds.begin(), majorants.bounds.end());
    if (const ColorGrid* color = extinction->color()) {
        record.flags |= shared::kMediumColorDensity;
        record.voxelOffset = std::uint32_t(scene.density.size());
        scene.density.insert(scene.density.end(), color->values.begin(), color->values.end());
        return;
    }
    record.voxelOffset = appendDensity(grid, bricked, scene);
    if (bricked) record.flags |= shared::kMediumBricked;
}

/// The largest grid of a kind: what to blame when all of them together are too large.
struct LargestGrid {
    std::size_t texels = 0;
    SourceLocation where;
    std::string name;

    void consider(const MediumDescription& medium, const GridPlacement& placement, const char* role) {
        if (texels > 0 && texelCount(placement) <= texels) return;
        const glm::uvec3 n = resolutionOf(placement.volume);
        texels = texelCount(placement);
        where = placement.where;
        name = fmt::format("{}: {} of {} x {} x {} voxels", nameOf(medium), role, n.x, n.y, n.z);
    }

    void requireAtMost(std::size_t needed, std::size_t allowed, const std::string& unit) const {
        if (needed <= allowed) return;
        throw InputError(where, fmt::format("{}, the largest grid: all grids of the scene together need {} {}; allowed "
                                            "are {}; half as many voxels along each axis need an eighth",
                                            name, needed, unit, allowed));
    }
};

/// Before the scene's own tables are allocated. Grids with a value a channel are always dense.
DensityPlan planStorage(std::span<const MediumDescription* const> media,
                        std::span<const std::optional<ExtinctionGrid>> extinctions, std::size_t memoryLimitBytes) {
    std::vector<const DensityGrid*> grids;
    LargestGrid density, albedo;
    std::size_t cells = 0, colored = 0, albedoCount = 0;
    for (std::size_t i = 0; i < media.size(); ++i) {
        if (extinctions[i]) {
            if (extinctions[i]->color())
                colored += extinctions[i]->color()->values.size();
            else
                grids.push_back(&extinctions[i]->largest());
            cells += extinctions[i]->largest().brickTable().size();
            density.consider(*media[i], *media[i]->density, "density");
        }
        if (media[i]->albedoGrid) {
            albedoCount += texelCount(*media[i]->albedoGrid);
            albedo.consider(*media[i], *media[i]->albedoGrid, "albedo");
        }
    }
    DensityPlan plan = planDensityStorage(grids);
    plan.voxels += colored;
    density.requireAtMost(plan.voxels, kMaxTexels,
                          plan.bricked ? "voxels of density in bricks that are not empty" : "voxels of density");
    density.requireAtMost(plan.tableEntries, kMaxTexels, "bricks of density");
    density.requireAtMost(cells, kMaxTexels, "majorants");
    albedo.requireAtMost(albedoCount, kMaxTexels, "voxels of albedo");
    const std::size_t densityBytes = plan.bytes() + sizeof(float) * cells,
                      albedoBytes = sizeof(glm::vec4) * albedoCount;
    (albedoBytes > densityBytes ? albedo : density)
        .requireAtMost(densityBytes + albedoBytes, memoryLimitBytes, "bytes of memory");
    return plan;
}

}  // namespace

std::vector<bool> findEmptyMedia(const SceneDescription& description, std::vector<std::string>& notes) {
    std::vector<bool> empty;
    for (const MediumDescription& medium : description.media) {
        if (medium.density && medium.density->cloud)
            throw InputError(medium.density->where,
                             nameOf(medium) + ": a procedural cloud must be baked (bakeClouds) before it is compiled");
        const bool noExtinction = !(float(largest(medium.sigmaT)) > 0.0f);
        const bool noDensity = medium.density && largestValue(medium.density->volume) == 0.0f;
        empty.push_back(noExtinction || noDensity);
        if (empty.back())
            notes.push_back(fmt::format("{} was dropped: its {} is zero", nameOf(medium),
                                        noExtinction ? "extinction" : "density grid"));
    }
    return empty;
}

void compileMedia(std::span<const MediumDescription* const> media, const glm::dvec3& worldOrigin,
                  std::size_t memoryLimitBytes, CompiledScene& scene) {
    if (media.size() > shared::kMaxMedia)
        throw InputError(media[shared::kMaxMedia]->where,
                         fmt::format("a scene may use at most {} media; got {}", shared::kMaxMedia, media.size()));
    std::vector<std::optional<ExtinctionGrid>> extinctions;
    for (const MediumDescription* medium : media) {
        extinctions.emplace_back();
        if (medium->density) extinctions.back().emplace(medium->density->volume);
    }
    const DensityPlan plan = planStorage(media, extinctions, memoryLimitBytes);
    scene.density.reserve(plan.voxels);
    scene.brickTable.reserve(plan.tableEntries);
    for (std::size_t i = 0; i < media.size(); ++i) {
        const MediumDescription* medium = media[i];
        shared::Medium record{};
        writeExtinction(*medium, record);
        compilePhase(medium->phase, nameOf(*medium), record, scene);
        writeAlbedo(*medium, worldOrigin, record, scene);
        writeDensity(*medium, extinctions[i] ? &*extinctions[i] : nullptr, worldOrigin, plan.bricked, record, scene);
        scene.constants.media[scene.constants.mediumCount++] = record;
    }
}

}  // namespace parhelion
