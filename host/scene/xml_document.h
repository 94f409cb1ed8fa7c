#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace parhelion {

struct XmlAttribute {
    std::string name;
    std::string value;
    SourceLocation nameWhere;
    SourceLocation where;  ///< first character of the value
};

struct XmlElement {
    std::string tag;
    SourceLocation where;  ///< the opening '<'
    std::vector<XmlAttribute> attributes;
    std::vector<XmlElement> children;

    /// The attribute of that name, or null.
    const XmlAttribute* find(std::string_view name) const;
    /// The attribute of that name.
    /// @throws InputError if it is missing.
    const XmlAttribute& require(std::string_view name) const;
};

/// Parses one UTF-8 XML file into elements that know where they were written. Comments, processing instructions and a
/// DOCTYPE are skipped.
///
/// @param where  blamed when the file cannot be read (the place that includes it).
/// @throws InputError for malformed XML, text between elements, repeated attributes, or nesting deeper than 64.
XmlElement readXml(const std::filesystem::path& file, const SourceLocation& where = {});

}  // namespace parhelion
