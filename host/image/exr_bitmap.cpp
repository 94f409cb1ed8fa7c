#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "image/bitmap_file.h"
#include "image/color_space.h"

namespace parhelion {

namespace {

using Names = std::array<std::string, 3>;

/// The sets of channels that make colours, in the order in which they are looked for, as in Mitsuba.
const std::array<Names, 4> kColours{{{"R", "G", "B"}, {"X", "Y", "Z"}, {"Y", "RY", "BY"}, {"Y", "Y", "Y"}}};

/// Colours found in a file: which set, and the channels' full names.
struct ColourChannels {
    Names set, names;
};

/// "layer." of "layer.R"; empty for channels of no layer.
std::string layerOf(const std::string& channel) { return channel.substr(0, channel.rfind('.') + 1); }

/// The channel of that name, in any case: the same letter first.
std::optional<std::string> findChannel(const Image& image, const std::string& name) {
    if (image.has(name)) return name;
    for (const auto& [candidate, values] : image.channels)
        if (std::ranges::equal(candidate, name,
                               [](unsigned char a, unsigned char b) { return std::toupper(a) == std::toupper(b); }))
            return candidate;
    return std::nullopt;
}

std::optional<ColourChannels> coloursIn(const Image& image, const std::string& layer) {
    for (const Names& set : kColours) {
        ColourChannels found{set, {}};
        int count = 0;
        for (int i = 0; i < 3; ++i)
            if (const auto channel = findChannel(image, layer + set[std::size_t(i)])) {
                found.names[std::size_t(i)] = *channel;
                ++count;
            }
        if (count == 3) return found;
    }
    return std::nullopt;
}

/// Those of no layer, or else of the only layer that has any.
/// @throws InputError if there are none, or several layers to choose from.
ColourChannels colourChannels(const BitmapFile& file, const Image& image) {
    if (auto found = coloursIn(image, "")) return *found;
    std::set<std::string> layers;
    for (const auto& [name, values] : image.channels) layers.insert(layerOf(name));
    std::string list;
    std::optional<ColourChannels> only;
    int count = 0;
    for (const std::string& layer : layers)
        if (const auto found = coloursIn(image, layer)) {
            only = found;
            list += (count++ > 0 ? ", " : "") + layer.substr(0, layer.size() - 1);
        }
    if (count > 1)
        file.fail("an EXR bitmap must have colours without a layer, or in one layer only; got them in the layers " +
                  list);
    if (!only) file.fail("an EXR bitmap must have the channels R, G and B; X, Y and Z; Y, RY and BY; or Y");
    return *only;
}

/// Tells of channels that were read in an unusual way, or not at all.
void noteChannels(const BitmapFile& file, const Image& image, const Names& names, Bitmap& bitmap) {
    if (const std::string layer = layerOf(names[0]); !layer.empty())
        file.note(bitmap, fmt::format("colours are those of the layer \"{}\"", layer.substr(0, layer.size() - 1)));
    std::string unused;
    int count = 0;
    for (const auto& [name, values] : image.channels) {
        const std::string bare = name.substr(layerOf(name).size());
        if (std::ranges::find(names, name) != names.end() || bare == "A" || bare == "a") continue;
        if (++count <= 8) unused += (count > 1 ? ", " : "") + name;
    }
    if (count > 0)
        file.note(bitmap,
                  fmt::format("{} further channels are not used: {}{}", count, unused, count > 8 ? ", ..." : ""));
    for (const std::string& name : std::set<std::string>(names.begin(), names.end()))
        if (image.integerChannels.contains(name))
            file.note(bitmap, fmt::format("channel {} holds whole numbers, which are taken as they are", name));
    for (const std::string& remark : image.remarks) file.note(bitmap, remark);
}

}  // namespace

Bitmap readExrBitmap(const BitmapFile& file) {
    const Image image = readExr(file.path, kMaxBitmapSize);
    Bitmap bitmap = file.makeBitmap(image.size.x, image.size.y);
    bitmap.environmentLayout = image.environmentLayout;
    const auto [set, names] = colourChannels(file, image);
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float>& values = image.channels.at(names[std::size_t(channel)]);
        for (std::size_t i = 0; i < values.size(); ++i) bitmap.texels[i][channel] = values[i];
    }
    noteChannels(file, image, names, bitmap);
    const Chromaticities space = image.chromaticities.value_or(kRec709);
    if (set[0] == "X")
        for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(kRec709FromXyz * glm::dvec3(texel));
    if (set[1] == "RY")
        for (glm::vec3& texel : bitmap.texels) texel = glm::vec3(rgbFromChroma(texel.x, texel.y, texel.z, space));
    if (set[0] == "R" || set[1] == "RY") convertPrimaries(file, space, bitmap, "\"chromaticities\"");
    return bitmap;
}

}  // namespace parhelion
