#include "scene/scene_tree.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/scene_loader.h"
#include "scene/suggestions.h"

namespace parhelion {

SceneTree SceneTree::load(const std::filesystem::path& file, XmlElement source,
                          const std::map<std::string, std::string>& defines) {
    SceneLoader loader(defines);
    SceneTree tree;
    tree.root_ = loader.load(file, std::move(source));
    tree.folders_ = loader.folders();
    tree.indexObjects(tree.root_);
    tree.addAliases(loader.aliases());
    return tree;
}

SceneTree SceneTree::ofNori(const std::filesystem::path& file, XmlElement root) {
    SceneTree tree;
    tree.dialect_ = Dialect::Nori;
    tree.root_ = std::move(root);
    tree.folders_ = {file.parent_path()};
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

const XmlElement& SceneTree::object(const XmlAttribute& id) const {
    if (const auto found = objects_.find(id.value); found != objects_.end()) return *found->second;
    std::vector<std::string> ids;
    for (const auto& [name, element] : objects_) ids.push_back(name);
    throw InputError(id.where, fmt::format("no object has the id \"{}\"{}", id.value, suggest(id.value, ids)));
}

std::filesystem::path SceneTree::resolveFile(const XmlAttribute& name) const {
    if (const auto file = findFile(name, folders_)) return *file;
    std::vector<std::string> searched;
    for (const std::filesystem::path& folder : folders_) searched.push_back(folder.empty() ? "." : folder.string());
    const std::filesystem::path besides = std::filesystem::path(name.where.file).parent_path();
    if (std::ranges::find(folders_, besides) == folders_.end()) searched.push_back(besides.string());
    throw InputError(name.where,
                     fmt::format("file \"{}\" not found; searched in: {}", name.value, fmt::join(searched, ", ")));
}

}  // namespace parhelion
