#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/xml_document.h"

namespace parhelion {

/// The languages that scenes are written in.
enum class Dialect { Mitsuba, Nori };

/// A scene's elements after everything textual is done: includes are spliced in, $names replaced, names of versions
/// before 2 upgraded, tags and attributes checked, ids indexed. No object refers to itself, however indirectly.
class SceneTree {
public:
    /// Of a scene in Mitsuba's dialect.
    ///
    /// @param source   the file as it was read.
    /// @param defines  values that win over the scene's <default>s.
    /// @throws InputError, located in the file that is wrong (which may be an included one).
    static SceneTree load(const std::filesystem::path& file, XmlElement source,
                          const std::map<std::string, std::string>& defines);

    /// Of a scene in Nori's dialect, which has neither includes nor references.
    ///
    /// @param root  checked by prepareNoriScene.
    static SceneTree ofNori(const std::filesystem::path& file, XmlElement root);

    SceneTree(SceneTree&&) = default;

    const XmlElement& root() const { return root_; }
    Dialect dialect() const { return dialect_; }

    /// The object an `id` attribute refers to, aliases followed.
    /// @throws InputError at the attribute if there is none.
    const XmlElement& object(const XmlAttribute& id) const;

    /// The file a value names: as it is if absolute, else searched in the main scene's <path> folders, the last one
    /// first, in its own folder, and in that of the file that says so.
    /// @throws InputError at the attribute, listing the folders.
    std::filesystem::path resolveFile(const XmlAttribute& name) const;

    /// The scene's file, those it includes, and all that resolveFile found so far.
    const std::vector<std::filesystem::path>& files() const { return files_; }

private:
    SceneTree() = default;
    void indexObjects(const XmlElement& parent);
    void addAliases(const std::vector<XmlElement>& aliases);
    void rejectCycles() const;

    Dialect dialect_ = Dialect::Mitsuba;
    XmlElement root_;
    std::vector<std::filesystem::path> folders_;
    mutable std::vector<std::filesystem::path> files_;
    std::map<std::string, const XmlElement*, std::less<>> objects_;  ///< point into root_
};

}  // namespace parhelion
