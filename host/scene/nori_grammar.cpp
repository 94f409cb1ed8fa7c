#include "scene/nori_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>

#include "scene/attribute_values.h"
#include "scene/suggestions.h"

namespace parhelion {
namespace {

struct TagRule {
    std::string tag;
    std::vector<std::string> attributes;  ///< all of them required
    std::vector<std::string> parents;
};

const std::vector<std::string> kObjects{"camera", "mesh",       "bsdf",    "emitter", "medium",
                                        "phase",  "integrator", "sampler", "rfilter"};

std::vector<TagRule> makeRules() {
    std::vector<TagRule> rules{{"scene", {}, {}},
                               {"camera", {"type"}, {"scene"}},
                               {"mesh", {"type"}, {"scene"}},
                               {"integrator", {"type"}, {"scene"}},
                               {"sampler", {"type"}, {"scene"}},
                               {"emitter", {"type"}, {"scene", "mesh"}},
                               {"medium", {"type"}, {"scene", "mesh"}},
                               {"bsdf", {"type"}, {"mesh"}},
                               {"rfilter", {"type"}, {"camera"}},
                               {"phase", {"type"}, {"medium"}},
                               {"transform", {"name"}, kObjects},
                               {"rotate", {"angle", "axis"}, {"transform"}},
                               {"lookat", {"origin", "target", "up"}, {"transform"}}};
    for (const char* tag : {"boolean", "integer", "float", "string", "point", "vector", "color"})
        rules.push_back({tag, {"name", "value"}, kObjects});
    for (const char* tag : {"translate", "scale", "matrix"}) rules.push_back({tag, {"value"}, {"transform"}});
    return rules;
}

std::span<const TagRule> allRules() {
    static const std::vector<TagRule> rules = makeRules();
    return rules;
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

std::vector<std::string> tagsAllowedIn(std::string_view parent) {
    std::vector<std::string> tags;
    for (const TagRule& rule : allRules())
        if (contains(rule.parents, parent)) tags.push_back(rule.tag);
    return tags;
}

const TagRule& ruleOf(const XmlElement& element, std::string_view parent) {
    const auto rule = std::ranges::find(allRules(), element.tag, &TagRule::tag);
    const bool isKnown = rule != allRules().end();
    if (!isKnown || !contains(rule->parents, parent))
        throw InputError(element.where, fmt::format("element <{}> is not {} inside <{}> in Nori's dialect{}",
                                                    element.tag, isKnown ? "allowed" : "known", parent,
                                                    suggest(element.tag, tagsAllowedIn(parent))));
    return *rule;
}

void checkAttributes(const XmlElement& element, const TagRule& rule) {
    for (const XmlAttribute& attribute : element.attributes)
        if (!contains(rule.attributes, attribute.name))
            throw InputError(attribute.nameWhere,
                             fmt::format("<{}> has no attribute \"{}\"{}", element.tag, attribute.name,
                                         suggest(attribute.name, rule.attributes)));
    for (const std::string& name : rule.attributes) element.require(name);
}

/// Where Mitsuba's dialect takes one number for all axes, or the upper left 3 x 3 of a matrix, Nori's does not.
void checkCounts(const XmlElement& element) {
    if (contains({"translate", "scale", "point", "vector"}, element.tag)) parseTriple(element.require("value"));
    if (element.tag == "rotate") parseTriple(element.require("axis"));
    if (element.tag != "matrix") return;
    const XmlAttribute& value = element.require("value");
    if (const std::size_t count = parseNumbers(value).size(); count != 16)
        throw InputError(value.where, fmt::format("matrix must have 16 numbers, row by row; got {}", count));
}

std::string camelCase(std::string_view name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool joins = name[i] == '_' && i > 0 && i + 1 < name.size();
        result += joins ? static_cast<char>(std::toupper(static_cast<unsigned char>(name[++i]))) : name[i];
    }
    return result;
}

void prepareElement(XmlElement& element, std::string_view parent) {
    const TagRule& rule = ruleOf(element, parent);
    checkAttributes(element, rule);
    checkCounts(element);
    for (XmlAttribute& attribute : element.attributes) {
        if (attribute.name == "name") attribute.value = camelCase(attribute.value);
        if (attribute.name == "axis") attribute.name = "value";
    }
    for (XmlElement& child : element.children) prepareElement(child, element.tag);
}

}  // namespace

bool isNoriScene(const XmlElement& root) {
    if (root.tag == "test") return true;
    return root.tag == "scene" && !root.find("version") &&
           std::ranges::any_of(root.children,
                               [](const XmlElement& child) { return child.tag == "camera" || child.tag == "mesh"; });
}

void prepareNoriScene(XmlElement& root) {
    if (root.tag == "test")
        throw InputError(root.where,
                         "a <test> lets Nori check its own samplers; a scene to render starts with <scene>");
    checkAttributes(root, allRules().front());
    for (XmlElement& child : root.children) prepareElement(child, root.tag);
}

}  // namespace parhelion
