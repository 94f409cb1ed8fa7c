#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/xml_document.h"

namespace parhelion {

/// The file that `name` means: itself if absolute, else the first that exists in `folders` and in the folder of the
/// file `name` is written in. Nothing if there is none.
std::optional<std::filesystem::path> findFile(const XmlAttribute& name,
                                              const std::vector<std::filesystem::path>& folders);

/// Reads a scene file and all that it includes into one tree, carrying out the directives on the way.
class SceneLoader {
public:
    explicit SceneLoader(const std::map<std::string, std::string>& defines);

    /// The <scene> element without <default>, <include>, <path> and <alias> children.
    ///
    /// @param source  the file as it was read.
    XmlElement load(const std::filesystem::path& file, XmlElement source);

    /// After load(): where the files that the scene names are searched, as in Mitsuba: in its own <path> folders, the
    /// last one first, then in its own folder. Those of included files do not count.
    const std::vector<std::filesystem::path>& folders() const { return folders_; }
    /// After load(): the scene's file and all that it includes.
    const std::vector<std::filesystem::path>& files() const { return files_; }
    /// After load(): the <alias> elements in order.
    const std::vector<XmlElement>& aliases() const { return aliases_; }

private:
    struct Variable {
        std::string value;
        bool fixed = false;  ///< given by the user, who is told if nothing uses it
        bool used = false;
    };

    /// A file that is being read.
    struct OpenFile {
        std::filesystem::path canonical;
        std::filesystem::path folder;
        std::vector<std::filesystem::path> paths;  ///< its <path> folders, the last one first
    };

    void loadChildren(XmlElement& source, XmlElement& target);
    void loadChild(XmlElement& child, XmlElement& target);
    void loadCheckedChild(XmlElement& child, XmlElement& target);
    void substitute(XmlElement& element);
    std::string substituted(const XmlAttribute& attribute);
    void setDefault(const XmlElement& element);
    void addFolder(const XmlAttribute& value);
    std::vector<std::filesystem::path> includeFolders() const;
    void include(const XmlElement& element, XmlElement& target);
    void splice(XmlElement& source, const XmlElement& include, XmlElement& target);
    void checkDefinesUsed() const;
    std::vector<std::string> variableNames() const;

    std::map<std::string, Variable, std::greater<>> variables_;
    std::vector<std::filesystem::path> folders_;
    std::vector<std::filesystem::path> files_;
    std::vector<OpenFile> openFiles_;  ///< each included by the one before
    std::vector<XmlElement> aliases_;
    std::size_t elementCount_ = 0;
    std::size_t includeCount_ = 0;
    std::size_t substitutedBytes_ = 0;
};

}  // namespace parhelion
