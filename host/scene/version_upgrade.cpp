#include "scene/version_upgrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace parhelion {
namespace {

constexpr int kNewestMajorVersion = 3;

/// The first number of "major[.minor[.patch]]".
int majorVersion(const XmlAttribute& version) {
    const std::string& text = version.value;
    int major = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), major);
    const bool wellFormed = error == std::errc{} && text.find_first_not_of("0123456789.") == std::string::npos &&
                            (end == text.data() + text.size() || *end == '.');
    if (!wellFormed || major > kNewestMajorVersion)
        throw InputError(version.where, fmt::format("scene version must be \"0.4.0\" to \"{}.x.y\"; got \"{:.40}\"",
                                                    kNewestMajorVersion, text));
    return major;
}

std::string snakeCase(const std::string& name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        if (std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]))) result += '_';
        result += static_cast<char>(std::isupper(c) ? std::tolower(c) : c);
    }
    return result;
}

/// Mitsuba's old placement of a texture: to_uv adds the offsets first, then scales.
void upgradePlacement(XmlElement& texture) {
    constexpr std::array<std::string_view, 4> kNames{"uoffset", "voffset", "uscale", "vscale"};
    XmlElement translate{"translate", texture.where, {}, {}}, scale{"scale", texture.where, {}, {}};
    std::erase_if(texture.children, [&](const XmlElement& child) {
        const XmlAttribute* name = child.find("name");
        const XmlAttribute* value = child.find("value");
        if (!name || !value || (child.tag != "float" && child.tag != "integer")) return false;
        const auto place = std::find(kNames.begin(), kNames.end(), name->value);
        if (place == kNames.end()) return false;
        const auto index = place - kNames.begin();
        XmlElement& step = index < 2 ? translate : scale;
        const std::string axis = index % 2 == 0 ? "x" : "y";
        if (step.find(axis)) return false;  // given twice, which is found to be unknown
        step.attributes.push_back({axis, value->value, value->nameWhere, value->where});
        return true;
    });
    if (translate.attributes.empty() && scale.attributes.empty()) return;
    texture.children.push_back({"transform", texture.where, {{"name", "to_uv", texture.where, texture.where}}, {}});
    texture.children.back().children = {std::move(translate), std::move(scale)};
}

void upgradeNames(XmlElement& element) {
    if (element.tag == "lookAt") element.tag = "lookat";
    if (element.tag != "default")
        for (XmlAttribute& attribute : element.attributes) {
            if (attribute.name != "name") continue;
            attribute.value = snakeCase(attribute.value);
            if (attribute.value == "diffuse_reflectance") attribute.value = "reflectance";
        }
    for (XmlElement& child : element.children) upgradeNames(child);
    if (element.tag == "texture") upgradePlacement(element);
}

}  // namespace

void upgradeVersion(XmlElement& root) {
    const XmlAttribute* version = root.tag == "scene" ? &root.require("version") : root.find("version");
    if (version && majorVersion(*version) < 2) upgradeNames(root);
}

}  // namespace parhelion
