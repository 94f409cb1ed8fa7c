#include "scene/scene_tree.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_map>

#include "scene/scene_loader.h"
#include "scene/suggestions.h"

namespace parhelion {
namespace {

/// One element on a walk down the tree.
struct Step {
    const XmlElement* element;
    std::size_t nextChild = 0;
};

std::string nameOf(const XmlElement& element) {
    const XmlAttribute* id = element.find("id");
    return id ? id->value : fmt::format("<{}>", element.tag);
}

/// "a -> b -> a", where `closing` is the a that the last element of `path` refers to.
std::string describeCycle(const std::vector<Step>& path, const XmlElement& closing) {
    std::string text;
    for (auto step = std::ranges::find(path, &closing, &Step::element); step != path.end(); ++step)
        text += nameOf(*step->element) + " -> ";
    return text + nameOf(closing);
}

}  // namespace

SceneTree SceneTree::load(const std::filesystem::path& file, XmlElement source,
                          const std::map<std::string, std::string>& defines) {
    SceneLoader loader(defines);
    SceneTree tree;
    tree.root_ = loader.load(file, std::move(source));
    tree.folders_ = loader.folders();
    tree.files_ = loader.files();
    tree.indexObjects(tree.root_);
    tree.addAliases(loader.aliases());
    tree.rejectCycles();
    return tree;
}

SceneTree SceneTree::ofNori(const std::filesystem::path& file, XmlElement root) {
    SceneTree tree;
    tree.dialect_ = Dialect::Nori;
    tree.root_ = std::move(root);
    tree.folders_ = {file.parent_path()};
    tree.files_ = {file};
    return tree;
}

void SceneTree::indexObjects(const XmlElement& parent) {
    for (const XmlElement& child : parent.children) {
        if (const XmlAttribute* id = child.tag == "ref" ? nullptr : child.find("id")) {
            const auto [existing, added] = objects_.try_emplace(id->value, &child);
            if (!added)
                throw InputError(id->where, fmt::format("id \"{}\" is taken already, at {}", id->value,
                                                        existing->second->where.text()));
        }
        indexObjects(child);
    }
}

void SceneTree::addAliases(const std::vector<XmlElement>& aliases) {
    for (const XmlElement& alias : aliases) {
        const XmlAttribute& name = alias.require("as");
        if (!objects_.try_emplace(name.value, &object(alias.require("id"))).second)
            throw InputError(name.where, fmt::format("id \"{}\" is taken already", name.value));
    }
}

/// A depth-first walk without recursion: chains of references may be long.
void SceneTree::rejectCycles() const {
    std::vector<Step> path{{&root_}};
    std::unordered_map<const XmlElement*, bool> left{{&root_, false}};  // of the elements met: false while on the path
    while (!path.empty()) {
        Step& step = path.back();
        if (step.nextChild == step.element->children.size()) {
            left[step.element] = true;
            path.pop_back();
            continue;
        }
        const XmlElement& child = step.element->children[step.nextChild++];
        const XmlElement& target = child.tag == "ref" ? object(child.require("id")) : child;
        if (target.children.empty()) continue;
        const auto [met, isNew] = left.try_emplace(&target, false);
        if (isNew)
            path.push_back({&target});
        else if (!met->second)
            throw InputError(child.where, fmt::format("circular reference: {}", describeCycle(path, target)));
    }
}

const XmlElement& SceneTree::object(const XmlAttribute& id) const {
    if (const auto found = objects_.find(id.value); found != objects_.end()) return *found->second;
    std::vector<std::string> ids;
    for (const auto& [name, element] : objects_) ids.push_back(name);
    throw InputError(id.where, fmt::format("no object has the id \"{}\"{}", id.value, suggest(id.value, ids)));
}

std::filesystem::path SceneTree::resolveFile(const XmlAttribute& name) const {
    if (const auto file = findFile(name, folders_)) {
        files_.push_back(*file);
        return *file;
    }
    std::vector<std::string> searched;
    for (const std::filesystem::path& folder : folders_) searched.push_back(folder.empty() ? "." : folder.string());
    const std::filesystem::path besides = std::filesystem::path(name.where.file).parent_path();
    if (std::ranges::find(folders_, besides) == folders_.end()) searched.push_back(besides.string());
    throw InputError(name.where,
                     fmt::format("file \"{}\" not found; searched in: {}", name.value, fmt::join(searched, ", ")));
}

}  // namespace parhelion
