#include "scene/version_upgrade.h"

#include <fmt/format.h>

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

void upgradeNames(XmlElement& element) {
    if (element.tag == "lookAt") element.tag = "lookat";
    if (element.tag != "default")
        for (XmlAttribute& attribute : element.attributes) {
            if (attribute.name != "name") continue;
            attribute.value = snakeCase(attribute.value);
            if (attribute.value == "diffuse_reflectance") attribute.value = "reflectance";
        }
    for (XmlElement& child : element.children) upgradeNames(child);
}

}  // namespace

void upgradeVersion(XmlElement& root) {
    if (root.tag == "scene" && majorVersion(root.require("version")) < 2) upgradeNames(root);
}

}  // namespace parhelion
