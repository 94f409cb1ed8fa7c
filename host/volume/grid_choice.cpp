#include "volume/grid_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

namespace parhelion {
namespace {

/// The names by which each grid can be asked for alone.
std::vector<std::string> makeLabels(std::span<const NamedGrid> grids) {
    std::map<std::string_view, std::size_t> sizes, seen;
    for (const NamedGrid& grid : grids) ++sizes[grid.name];
    std::vector<std::string> labels;
    for (const NamedGrid& grid : grids) {
        const std::size_t index = seen[grid.name]++;
        const std::string number = grid.number.empty() ? std::to_string(index) : grid.number;
        const bool isUnique = sizes[grid.name] == 1 && !grid.name.empty();
        labels.push_back(isUnique ? grid.name : fmt::format("{}[{}]", grid.name, number));
    }
    return labels;
}

std::optional<std::size_t> find(std::span<const NamedGrid> grids, std::span<const std::string> labels,
                                const std::string& wanted) {
    std::optional<std::size_t> any, byName, byLabel;
    const std::string name = wanted.empty() ? "density" : wanted;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (!grids[i].isReadable) continue;
        if (!any) any = i;
        if (!byName && grids[i].name == name) byName = i;
        const bool isNumbered =
            !grids[i].number.empty() && name == fmt::format("{}[{}]", grids[i].name, grids[i].number);
        if (!byLabel && (labels[i] == name || isNumbered)) byLabel = i;
    }
    if (byName) return byName;
    return wanted.empty() ? any : byLabel;
}

/// What a user should know of the grids that were not chosen, but might as well have been.
std::string noteOthers(std::span<const NamedGrid> grids, std::span<const std::string> labels, std::size_t chosen,
                       const std::string& wanted) {
    const bool wasNumbered = !wanted.empty() && wanted != grids[chosen].name;
    if (wasNumbered) return {};
    const bool anyName = wanted.empty() && grids[chosen].name != "density";
    std::vector<std::string> others;
    for (std::size_t i = 0; i < grids.size(); ++i)
        if (i != chosen && grids[i].isReadable && (anyName || grids[i].name == grids[chosen].name))
            others.push_back(fmt::format("\"{}\"", labels[i]));
    if (others.empty()) return {};
    return fmt::format("of {} grids{} the first, \"{}\", was read; others can be named: {}", others.size() + 1,
                       anyName ? "" : fmt::format(" \"{}\"", grids[chosen].name), labels[chosen],
                       fmt::join(others, ", "));
}

}  // namespace

GridChoice chooseGrid(std::span<const NamedGrid> grids, std::string_view types, const VolumeBytes& input) {
    const std::vector<std::string> labels = makeLabels(grids);
    const std::string& wanted = input.options.gridName;
    if (const auto chosen = find(grids, labels, wanted))
        return {*chosen, labels[*chosen], noteOthers(grids, labels, *chosen, wanted)};
    std::string found;
    for (std::size_t i = 0; i < grids.size(); ++i)
        found += fmt::format("{}\"{}\" ({})", i == 0 ? "" : ", ", labels[i], grids[i].type);
    throw InputError(input.where,
                     fmt::format("must hold a grid{} of type {}; got {}", wanted.empty() ? "" : " \"" + wanted + "\"",
                                 types, found.empty() ? "none" : found));
}

}  // namespace parhelion
