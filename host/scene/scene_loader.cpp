#include "scene/scene_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/scene_grammar.h"
#include "scene/suggestions.h"
#include "scene/version_upgrade.h"

namespace parhelion {
namespace {

// A file that includes another twice, which includes another twice, ... grows without bound; a real scene does not.
constexpr std::size_t kMostElements = 1'000'000;
constexpr std::size_t kMostIncludes = 10'000;
constexpr std::size_t kDeepestInclude = 32;
// Likewise a <default> that names another one twice.
constexpr std::size_t kLongestValue = 65536;
constexpr std::size_t kMostSubstitutedBytes = std::size_t{64} << 20;

std::filesystem::path canonicalPath(const std::filesystem::path& file) {
    std::error_code ignored;  // a path that cannot be resolved is reported when it is read
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(file, ignored);
    return canonical.empty() ? file : canonical;
}

bool isDirective(const XmlElement& element) {
    constexpr std::array<std::string_view, 4> kDirectives{"default", "path", "alias", "include"};
    return std::ranges::find(kDirectives, element.tag) != kDirectives.end();
}

}  // namespace

std::optional<std::filesystem::path> findFile(const XmlAttribute& name,
                                              const std::vector<std::filesystem::path>& folders) {
    std::error_code ignored;
    const std::filesystem::path path(name.value);
    for (const std::filesystem::path& folder : folders)
        if (std::filesystem::exists(folder / path, ignored)) return folder / path;
    const std::filesystem::path besides = std::filesystem::path(name.where.file).parent_path() / path;
    if (std::filesystem::exists(besides, ignored)) return besides;
    return std::nullopt;
}

SceneLoader::SceneLoader(const std::map<std::string, std::string>& defines) {
    for (const auto& [name, value] : defines) variables_[name] = {value, /*fixed*/ true, /*used*/ false};
}

XmlElement SceneLoader::load(const std::filesystem::path& file, XmlElement source) {
    if (source.tag != "scene")
        throw InputError(source.where,
                         fmt::format("a scene file starts with <scene version=\"3.0.0\">; got <{}>", source.tag));
    upgradeVersion(source);
    checkElement(source, "");
    files_ = {file};
    openFiles_ = {{canonicalPath(file), file.parent_path(), {}}};
    XmlElement target{source.tag, source.where, source.attributes, {}};
    loadChildren(source, target);
    checkDefinesUsed();
    folders_ = openFiles_.front().paths;
    folders_.push_back(openFiles_.front().folder);
    return target;
}

void SceneLoader::loadChildren(XmlElement& source, XmlElement& target) {
    for (XmlElement& child : source.children) loadChild(child, target);
}

void SceneLoader::loadChild(XmlElement& child, XmlElement& target) {
    checkElement(child, target.tag);
    loadCheckedChild(child, target);
}

void SceneLoader::loadCheckedChild(XmlElement& child, XmlElement& target) {
    if (++elementCount_ > kMostElements)
        throw InputError(child.where, fmt::format("a scene may have at most {} elements", kMostElements));
    substitute(child);
    if (child.tag == "default") return setDefault(child);
    if (child.tag == "path") return addFolder(child.require("value"));
    if (child.tag == "alias") return aliases_.push_back(std::move(child));
    if (child.tag == "include") return include(child, target);
    XmlElement& copy =
        target.children.emplace_back(XmlElement{child.tag, child.where, std::move(child.attributes), {}});
    loadChildren(child, copy);
}

void SceneLoader::substitute(XmlElement& element) {
    for (XmlAttribute& attribute : element.attributes)
        if (attribute.value.find('$') != std::string::npos) attribute.value = substituted(attribute);
}

std::string SceneLoader::substituted(const XmlAttribute& attribute) {
    const std::string& text = attribute.value;
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] != '$') {
            result += text[i++];
            continue;
        }
        const std::string_view rest = std::string_view(text).substr(i + 1);
        // As Mitsuba: the longest defined name that what follows begins with. In descending order, longer names with
        // the same beginning come first.
        const auto variable = std::ranges::find_if(
            variables_, [rest](const auto& entry) { return !entry.first.empty() && rest.starts_with(entry.first); });
        if (variable == variables_.end()) {
            const std::string_view name = rest.substr(0, rest.find_first_of(" ,/.$"));
            throw InputError(attribute.where, fmt::format("undefined variable \"${}\"; set it with <default> before "
                                                          "this line or with -D{}",
                                                          name, suggest(name, variableNames())));
        }
        variable->second.used = true;
        result += variable->second.value;
        i += 1 + variable->first.size();
        if (result.size() > kLongestValue)
            throw InputError(attribute.where,
                             fmt::format("value is longer than {} characters after replacing $names", kLongestValue));
    }
    substitutedBytes_ += result.size();
    if (substitutedBytes_ > kMostSubstitutedBytes)
        throw InputError(attribute.where, fmt::format("the values of a scene may have at most {} characters after "
                                                      "replacing $names",
                                                      kMostSubstitutedBytes));
    return result;
}

void SceneLoader::setDefault(const XmlElement& element) {
    const XmlAttribute& name = element.require("name");
    if (name.value.empty()) throw InputError(name.where, "a <default> needs a name");
    variables_.try_emplace(name.value, Variable{element.require("value").value});  // the first one wins, as in Mitsuba
}

void SceneLoader::addFolder(const XmlAttribute& value) {
    const auto folder = findFile(value, includeFolders());
    std::error_code ignored;
    if (!folder || !std::filesystem::is_directory(*folder, ignored))
        throw InputError(value.where, fmt::format("<path> must name a folder; there is none \"{}\"", value.value));
    std::vector<std::filesystem::path>& paths = openFiles_.back().paths;
    paths.insert(paths.begin(), *folder);
}

/// As in Mitsuba, a file's own folder and its <path>s, the last one first, come before those of the file that
/// includes it.
std::vector<std::filesystem::path> SceneLoader::includeFolders() const {
    std::vector<std::filesystem::path> folders;
    for (auto file = openFiles_.rbegin(); file != openFiles_.rend(); ++file) {
        folders.push_back(file->folder);
        folders.insert(folders.end(), file->paths.begin(), file->paths.end());
    }
    return folders;
}

void SceneLoader::include(const XmlElement& element, XmlElement& target) {
    const XmlAttribute& name = element.require("filename");
    const std::optional<std::filesystem::path> file = findFile(name, includeFolders());
    if (!file) throw InputError(name.where, fmt::format("included file \"{}\" not found", name.value));
    const std::filesystem::path canonical = canonicalPath(*file);
    if (std::ranges::find(openFiles_, canonical, &OpenFile::canonical) != openFiles_.end())
        throw InputError(name.where, fmt::format("\"{}\" includes itself", name.value));
    if (openFiles_.size() >= kDeepestInclude)
        throw InputError(name.where, fmt::format("includes are nested more than {} deep", kDeepestInclude));
    if (++includeCount_ > kMostIncludes)
        throw InputError(name.where, fmt::format("a scene may include at most {} files", kMostIncludes));

    XmlElement source = readXml(*file, name.where);
    upgradeVersion(source);
    files_.push_back(*file);
    openFiles_.push_back({canonical, file->parent_path(), {}});
    splice(source, element, target);
    openFiles_.pop_back();
}

void SceneLoader::splice(XmlElement& source, const XmlElement& include, XmlElement& target) {
    const XmlAttribute* role = include.find("name");
    if (source.tag != "scene") {
        std::erase_if(source.attributes, [role](const XmlAttribute& attribute) {
            return attribute.name == "version" || (role && attribute.name == "name");
        });
        if (role) source.attributes.push_back(*role);
        return loadChild(source, target);
    }
    if (role) throw InputError(role->nameWhere, "<include> takes a name only if the file holds one object, no <scene>");
    checkElement(source, "");
    for (XmlElement& child : source.children) {
        checkElement(child, source.tag);
        if (isPropertyTag(child.tag) && target.tag != "scene")
            throw InputError(child.where, fmt::format("a property of a scene is not one of <{}>", target.tag));
        if (!isDirective(child)) checkElement(child, target.tag);
        loadCheckedChild(child, target);
    }
}

void SceneLoader::checkDefinesUsed() const {
    for (const auto& [name, variable] : variables_)
        if (variable.fixed && !variable.used) {
            std::vector<std::string> others = variableNames();
            std::erase(others, name);
            throw InputError(fmt::format("-D {}: the scene uses no \"${}\"{}", name, name, suggest(name, others)));
        }
}

std::vector<std::string> SceneLoader::variableNames() const {
    std::vector<std::string> names;
    for (const auto& [name, variable] : variables_) names.push_back(name);
    std::ranges::sort(names);
    return names;
}

}  // namespace parhelion
