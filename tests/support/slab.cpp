#include "slab.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "analysis/statistics.h"
#include "scene/scene_description.h"
#include "support/temporary_folder.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
}

std::string phaseText(const SlabRow& slab) {
    if (slab.weight == 1) return fmt::format(R"(<phase type="hg"><float name="g" value="{}"/></phase>)", slab.g);
    return fmt::format(R"(<phase type="dual_hg"><float name="g1" value="{}"/><float name="g2" value="{}"/>
        <float name="weight" value="{}"/></phase>)",
                       slab.g, slab.g2, slab.weight);
}

std::string mediumText(const SlabRow& slab, const SlabView& view, const TemporaryFolder& folder) {
    const double sigma = slab.tau / view.thickness;
    std::string extinction = fmt::format(R"(<float name="sigma_t" value="{}"/>)", sigma);
    if (view.constantGrid) {
        Volume ones;
        ones.density = DensityGrid({2, 2, 2});
        for (unsigned i = 0; i < 8; ++i) ones.density.set({i & 1, i >> 1 & 1, i >> 2}, 1);
        writeVolume(folder.path() / "ones.vol", ones);
        extinction = fmt::format(R"(<float name="scale" value="{}"/>
            <volume name="sigma_t" type="gridvolume"><string name="filename" value="ones.vol"/>
            <transform name="to_world"><translate x="-0.5" y="-1" z="-0.5"/><scale x="{}" y="{}" z="{}"/></transform>
            </volume>)",
                                 sigma, 2e4 * view.thickness, view.thickness, 2e4 * view.thickness);
    }
    return fmt::format(R"(<medium type="{}" id="slab">{}<float name="albedo" value="{}"/>
        {}</medium>)",
                       view.constantGrid ? "heterogeneous" : "homogeneous", extinction, slab.albedo, phaseText(slab));
}

std::string sensorText(const SlabView& view) {
    return fmt::format(R"(<sensor type="perspective"><float name="fov" value="0.1"/>
        <transform name="to_world"><lookat origin="{}, {}, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
        <film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/>
        <rfilter type="box"/></film></sensor>)",
                       view.thickness * std::sqrt(1 / (view.mu * view.mu) - 1), view.thickness, view.size, view.size);
}

std::string shapesText(const SlabView& view) {
    const double planeHeight = view.litFromAbove ? -1.001 : 1.5;
    return fmt::format(R"(<shape type="cube"><bsdf type="null"/><ref name="interior" id="slab"/>
        <transform name="to_world"><scale x="1e4" y="0.5" z="1e4"/><translate y="-0.5"/><scale value="{0}"/>
        </transform></shape>
        <shape type="rectangle"><bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="0"/>
        </bsdf></bsdf><transform name="to_world">
        <rotate x="1" angle="-90"/><scale x="1e4" z="1e4"/><translate y="{1}"/><scale value="{0}"/>
        </transform></shape>)",
                       view.thickness, planeHeight);
}

}  // namespace

std::string SlabRow::name() const {
    const std::string second = weight == 1 ? "" : fmt::format(" ({}) and {}", weight, g2);
    return fmt::format("tau {} albedo {} g {}{}", tau, albedo, g, second);
}

double SlabRow::exact(double mu, bool litFromAbove) const {
    if (mu == 1) return litFromAbove ? reflected1 : transmitted1;
    return litFromAbove ? reflected05 : transmitted05;
}

std::vector<SlabRow> readSlabRows(const std::filesystem::path& table) {
    std::ifstream file(table);
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> names = cellsOf(line);
    std::vector<SlabRow> rows;
    while (std::getline(file, line)) {
        std::map<std::string, std::string> cell;
        const std::vector<std::string> cells = cellsOf(line);
        for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) cell[names[i]] = cells[i];
        const auto number = [&cell](const char* column) { return std::stod(cell.at(column)); };
        SlabRow lobes;
        if (cell.at("phase") == "HG") {
            lobes.g = number("g");
        } else if (std::sscanf(cell.at("g").c_str(), "%lf*HG(%lf)+%*f*HG(%lf)", &lobes.weight, &lobes.g, &lobes.g2) !=
                   3) {
            throw std::runtime_error("unknown phase function: " + cell.at("g"));
        }
        rows.push_back({.tau = number("tau"),
                        .albedo = number("albedo"),
                        .g = lobes.g,
                        .g2 = lobes.g2,
                        .weight = lobes.weight,
                        .reflected1 = number("R_mu1"),
                        .transmitted1 = number("Ttot_mu1"),
                        .reflected05 = number("R_mu05"),
                        .transmitted05 = number("Ttot_mu05")});
    }
    return rows;
}

CompiledScene slabScene(const SlabRow& slab, const SlabView& view) {
    const TemporaryFolder folder;
    const std::string text = fmt::format(
        R"(<scene version="3.0.0"><integrator type="volpath"><integer name="rr_depth" value="64"/></integrator>
        <emitter type="constant"><float name="radiance" value="1"/></emitter>{}{}{}</scene>)",
        sensorText(view), mediumText(slab, view, folder), shapesText(view));
    return compileScene(readScene(folder.write("slab.xml", text)));
}

std::uint64_t samplesFor(const CompiledScene& scene, double events) {
    const Film pilot = renderOn(Backend::Reference, scene, 1);
    const double eventsPerPass = double(pilot.counters[shared::kCounterVertices]) + double(pilot.pixels.size());
    return static_cast<std::uint64_t>(std::max(1.0, events / eventsPerPass));
}

SlabScores::SlabScores(std::size_t tests) : threshold_(twoSidedThreshold(sidak(1e-6, tests))) {}

void SlabScores::add(const PixelEstimate& found, double exact, const std::string& what) {
    const double error = std::hypot(found.error, 1e-6);
    const double z = (found.mean - exact) / error;
    const double relativeError = error / exact;
    fmt::print("{}: {:.6f} +- {:.6f}, exact {:.6f}, z {:+.2f}; would have found {:.2f} %\n", what, found.mean,
               found.error, exact, z, 100 * detectableDeviation(threshold_) * relativeError);
    EXPECT_LE(std::abs(z), threshold_) << what;
    collect(found, exact);
}

void SlabScores::collect(const PixelEstimate& found, double exact) {
    const double relativeError = std::hypot(found.error, 1e-6) / exact;
    weightedBias_ += (found.mean / exact - 1) / (relativeError * relativeError);
    weight_ += 1 / (relativeError * relativeError);
}

void SlabScores::pool(const SlabScores& other) {
    weightedBias_ += other.weightedBias_;
    weight_ += other.weight_;
}

void SlabScores::expectNoCommonBias(double resolution, const std::string& what) const {
    const double error = 1 / std::sqrt(weight_), bias = weightedBias_ / weight_;
    const double detectable = detectableDeviation(twoSidedThreshold(1e-6)) * error;
    fmt::print("{}: common bias {:+.4f} % +- {:.4f} %; would have found {:.3f} %\n", what, 100 * bias, 100 * error,
               100 * detectable);
    EXPECT_FALSE(haveCommonBias()) << what;
    EXPECT_LE(detectable, resolution) << what;
}

bool SlabScores::haveCommonBias() const {
    // The weighted mean over its error, 1 / sqrt(weight).
    return std::abs(weightedBias_) / std::sqrt(weight_) > twoSidedThreshold(1e-6);
}

}  // namespace parhelion::test
