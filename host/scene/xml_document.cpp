#include "scene/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "base/files.h"
#include "base/text_encoding.h"

namespace parhelion {
namespace {

constexpr int kDeepestNesting = 64;

/// Turns byte offsets of one file into lines and columns.
class LineTable {
public:
    LineTable(std::string file, std::string_view text) : file_(std::move(file)), size_(text.size()) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') starts_.push_back(i + 1);
    }

    SourceLocation at(std::size_t offset) const {
        offset = std::min(offset, size_);
        const auto line = std::upper_bound(starts_.begin(), starts_.end(), offset) - 1;
        return {file_, static_cast<int>(line - starts_.begin()) + 1, static_cast<int>(offset - *line) + 1};
    }

private:
    std::string file_;
    std::size_t size_;
    std::vector<std::size_t> starts_{0};
};

/// pugixml keeps no attribute positions, but it parses in place: names and values still point into the buffer.
class ElementReader {
public:
    ElementReader(const LineTable& lines, const std::string& buffer) : lines_(lines), buffer_(buffer) {}

    XmlElement read(const pugi::xml_node& node, int depth) const {
        const SourceLocation where = elementLocation(node);
        if (depth > kDeepestNesting)
            throw InputError(where, fmt::format("elements are nested more than {} deep", kDeepestNesting));
        XmlElement element{node.name(), where, {}, {}};
        for (const pugi::xml_attribute& attribute : node.attributes()) addAttribute(attribute, element);
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() == pugi::node_element) {
                element.children.push_back(read(child, depth + 1));
            } else {
                throw InputError(
                    textLocation(child),
                    fmt::format("text inside <{}> is not allowed; values go into attributes; got \"{:.40}\"",
                                element.tag, child.value()));
            }
        }
        return element;
    }

    SourceLocation elementLocation(const pugi::xml_node& node) const {
        const std::ptrdiff_t name = node.offset_debug();
        return lines_.at(name > 0 ? static_cast<std::size_t>(name - 1) : 0);
    }

private:
    void addAttribute(const pugi::xml_attribute& attribute, XmlElement& element) const {
        const SourceLocation nameWhere = pointerLocation(attribute.name(), element.where);
        if (element.find(attribute.name()))
            throw InputError(nameWhere, fmt::format("<{}> has attribute \"{}\" twice", element.tag, attribute.name()));
        element.attributes.push_back(
            {attribute.name(), attribute.value(), nameWhere, pointerLocation(attribute.value(), nameWhere)});
    }

    SourceLocation textLocation(const pugi::xml_node& node) const {
        const std::string_view text = node.value();
        const std::size_t indentation = std::min(text.find_first_not_of(" \t\n"), text.size());
        return pointerLocation(node.value() + indentation, elementLocation(node.parent()));
    }

    SourceLocation pointerLocation(const char* pointer, const SourceLocation& fallback) const {
        const std::less<const char*> before;
        const char* begin = buffer_.data();
        if (before(pointer, begin) || !before(pointer, begin + buffer_.size())) return fallback;
        return lines_.at(static_cast<std::size_t>(pointer - begin));
    }

    const LineTable& lines_;
    const std::string& buffer_;
};

std::string readUtf8(const std::filesystem::path& file, const SourceLocation& where) {
    const std::string text = readTextFile(file, where);
    if (const std::string reason = whyNotUtf8(text); !reason.empty())
        throw InputError(SourceLocation{file.string()},
                         fmt::format("not a text file; a scene is XML in UTF-8, and this is {}", reason));
    return std::string(withoutByteOrderMark(text));
}

}  // namespace

const XmlAttribute* XmlElement::find(std::string_view name) const {
    const auto found = std::ranges::find(attributes, name, &XmlAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}

const XmlAttribute& XmlElement::require(std::string_view name) const {
    if (const XmlAttribute* attribute = find(name)) return *attribute;
    throw InputError(where, fmt::format("<{}> needs an attribute \"{}\"", tag, name));
}

XmlElement readXml(const std::filesystem::path& file, const SourceLocation& where) {
    std::string text = readUtf8(file, where);
    const LineTable lines(file.string(), text);
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer_inplace(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
        throw InputError(lines.at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
                         fmt::format("malformed XML: {}", result.description()));
    const ElementReader reader(lines, text);
    const pugi::xml_node root = document.document_element();
    if (const pugi::xml_node second = root.next_sibling())
        throw InputError(reader.elementLocation(second), "only one element may be at the top of a file");
    return reader.read(root, 0);
}

}  // namespace parhelion
