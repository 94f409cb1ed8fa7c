#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/effect_names.h"
#include "app/scene_inventory.h"
#include "app/text_format.h"

namespace parhelion::app {

namespace {

using Json = nlohmann::ordered_json;

template <int N, typename T>
Json toArray(const glm::vec<N, T>& vector) {
    Json array = Json::array();
    for (int i = 0; i < N; ++i) array.push_back(vector[i]);
    return array;
}

Json toJson(const LightEntry& light) {
    return {{"type", light.type},
            {"emission", toArray(light.emission)},
            {"selection", light.selection},
            {"triangles", light.triangles}};
}

Json toJson(const MediumEntry& medium) {
    return {{"type", medium.type},
            {"phase", medium.phase},
            {"extinction", toArray(medium.extinction)},
            {"albedo", toArray(medium.albedo)},
            {"resolution", toArray(medium.resolution)},
            {"bricked", medium.bricked},
            {"occupancy", medium.occupancy},
            {"albedoResolution", toArray(medium.albedoResolution)}};
}

std::string describe(const LightEntry& light) {
    std::string text = fmt::format("light     {}, emission {}", light.type, formatColor(light.emission));
    if (light.triangles > 0) text += fmt::format(", {} triangles", light.triangles);
    return text + (light.selection > 0 ? fmt::format(", sampled with probability {:.3g}\n", light.selection)
                                       : ", met by scattering only\n");
}

std::string describe(const MediumEntry& medium) {
    std::string text = fmt::format("medium    {}, extinction {}, albedo {}, {}", medium.type,
                                   formatColor(medium.extinction), formatColor(medium.albedo), medium.phase);
    if (medium.resolution.x > 0)
        text += fmt::format(", {} voxels{}, {} of the cells occupied", formatSize(medium.resolution),
                            medium.bricked ? " in bricks" : "", formatPercent(medium.occupancy));
    if (medium.albedoResolution.x > 0) text += fmt::format(", albedo grid of {}", formatSize(medium.albedoResolution));
    return text + "\n";
}

std::string describeContents(const SceneInventory& inventory) {
    std::string text =
        fmt::format("film      {}, {} samples per pixel\n", formatSize(inventory.filmSize), inventory.sampleCount);
    if (inventory.cropSize != inventory.filmSize)
        text += fmt::format("crop      {} at {},{}\n", formatSize(inventory.cropSize), inventory.cropOffset.x,
                            inventory.cropOffset.y);
    text += fmt::format(
        "shapes    {} ({} of them invisible boundaries): {} parallelograms, {} spheres, {} boxes, "
        "{} triangles\n",
        inventory.shapes, inventory.boundaries, inventory.quads, inventory.spheres, inventory.boxes,
        inventory.triangles);
    for (const LightEntry& light : inventory.lights) text += describe(light);
    for (const MediumEntry& medium : inventory.media) text += describe(medium);
    return text;
}

std::string describeMemory(const SceneInventory& inventory) {
    std::string text = fmt::format("\nmemory    {}\n", formatBytes(static_cast<double>(inventory.memoryBytes)));
    for (const ArraySize& array : inventory.arrays)
        if (array.bytes > 0)
            text += fmt::format("  {:<18} {:>10}\n", array.name, formatBytes(static_cast<double>(array.bytes)));
    return text;
}

std::string describeEffects(const EffectSet& effects) {
    std::size_t width = 0;
    for (const EffectName& name : kEffectNames) width = std::max(width, std::string_view(name.label).size());
    std::string text = "\neffects   simulated (yes) or skipped (no)\n";
    for (unsigned effect = 0; effect < kEffectCount; ++effect)
        text += fmt::format("  {:<{}}  {}\n", kEffectNames[effect].label, width, effects.reasons[effect]);
    return text;
}

}  // namespace

Json toJson(const SceneInventory& inventory) {
    Json json = {{"filmSize", toArray(inventory.filmSize)},
                 {"cropOffset", toArray(inventory.cropOffset)},
                 {"cropSize", toArray(inventory.cropSize)},
                 {"samples", inventory.sampleCount},
                 {"shapes", inventory.shapes},
                 {"boundaries", inventory.boundaries},
                 {"quads", inventory.quads},
                 {"spheres", inventory.spheres},
                 {"boxes", inventory.boxes},
                 {"triangles", inventory.triangles},
                 {"lights", Json::array()},
                 {"media", Json::array()},
                 {"memoryBytes", inventory.memoryBytes},
                 {"arrays", Json::array()},
                 {"effects", Json::array()},
                 {"notes", inventory.notes}};
    for (const LightEntry& light : inventory.lights) json["lights"].push_back(toJson(light));
    for (const MediumEntry& medium : inventory.media) json["media"].push_back(toJson(medium));
    for (const ArraySize& array : inventory.arrays)
        json["arrays"].push_back({{"name", array.name}, {"bytes", array.bytes}});
    for (unsigned effect = 0; effect < kEffectCount; ++effect)
        json["effects"].push_back({{"name", kEffectNames[effect].identifier},
                                   {"label", kEffectNames[effect].label},
                                   {"simulated", inventory.effects.on[effect]},
                                   {"reason", inventory.effects.reasons[effect]}});
    return json;
}

std::string describe(const SceneInventory& inventory) {
    std::string text = describeContents(inventory) + describeMemory(inventory) + describeEffects(inventory.effects);
    for (const std::string& note : inventory.notes) text += fmt::format("\nnote: {}\n", note);
    return text;
}

}  // namespace parhelion::app
