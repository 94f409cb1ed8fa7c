#include "scene/scene_grammar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "scene/suggestions.h"

namespace parhelion {
namespace {

enum class Kind { Scene, Object, Value, Transform, TransformStep, Reference, Directive };

struct TagRule {
    std::string tag;
    Kind kind;
    std::vector<std::string> required;
    std::vector<std::string> optional;
};

std::vector<TagRule> makeRules() {
    std::vector<TagRule> rules{{"scene", Kind::Scene, {"version"}, {}},
                               {"transform", Kind::Transform, {"name"}, {}},
                               {"translate", Kind::TransformStep, {}, {"value", "x", "y", "z"}},
                               {"scale", Kind::TransformStep, {}, {"value", "x", "y", "z"}},
                               {"rotate", Kind::TransformStep, {"angle"}, {"value", "x", "y", "z"}},
                               {"lookat", Kind::TransformStep, {"origin", "target"}, {"up"}},
                               {"matrix", Kind::TransformStep, {"value"}, {}},
                               {"ref", Kind::Reference, {"id"}, {"name"}},
                               {"include", Kind::Directive, {"filename"}, {"name"}},
                               {"default", Kind::Directive, {"name", "value"}, {}},
                               {"path", Kind::Directive, {"value"}, {}},
                               {"alias", Kind::Directive, {"id", "as"}, {}},
                               {"point", Kind::Value, {"name"}, {"value", "x", "y", "z"}},
                               {"vector", Kind::Value, {"name"}, {"value", "x", "y", "z"}}};
    for (const char* tag : {"float", "integer", "boolean", "string", "rgb", "spectrum"})
        rules.push_back({tag, Kind::Value, {"name", "value"}, {}});
    for (const char* tag : {"integrator", "sensor", "sampler", "film", "rfilter", "emitter", "shape", "bsdf", "medium",
                            "phase", "volume", "texture"})
        rules.push_back({tag, Kind::Object, {"type"}, {"id", "name"}});
    return rules;
}

std::span<const TagRule> allRules() {
    static const std::vector<TagRule> rules = makeRules();
    return rules;
}

const TagRule* findRule(std::string_view tag) {
    const auto found = std::ranges::find(allRules(), tag, &TagRule::tag);
    return found == allRules().end() ? nullptr : &*found;
}

bool mayStandIn(const TagRule& child, const TagRule* parent) {
    if (!parent) return child.kind == Kind::Scene || child.kind == Kind::Object;
    switch (child.kind) {
        case Kind::Scene:
            return false;
        case Kind::Object:
            return parent->kind == Kind::Scene || parent->kind == Kind::Object;
        case Kind::Value:
            return parent->kind == Kind::Object || (parent->kind == Kind::Scene && child.tag == "boolean");
        case Kind::Transform:
        case Kind::Reference:
            return parent->kind == Kind::Object;
        case Kind::TransformStep:
            return parent->kind == Kind::Transform;
        case Kind::Directive:
            return parent->kind == Kind::Scene || child.tag == "include" || child.tag == "default";
    }
    return false;
}

std::vector<std::string> tagsAllowedIn(const TagRule* parent) {
    std::vector<std::string> tags;
    for (const TagRule& rule : allRules())
        if (mayStandIn(rule, parent)) tags.push_back(rule.tag);
    return tags;
}

}  // namespace

bool isObjectTag(std::string_view tag) {
    const TagRule* rule = findRule(tag);
    return (rule && rule->kind == Kind::Object) || tag == "mesh" || tag == "camera";
}

bool isPropertyTag(std::string_view tag) {
    const TagRule* rule = findRule(tag);
    return (rule && (rule->kind == Kind::Value || rule->kind == Kind::Transform)) || tag == "color";
}

void checkElement(const XmlElement& element, std::string_view parent) {
    const TagRule* rule = findRule(element.tag);
    const TagRule* parentRule = findRule(parent);
    if (!rule || !mayStandIn(*rule, parentRule)) {
        const std::string place = parentRule ? fmt::format("inside <{}>", parent) : "at the top of a scene file";
        throw InputError(element.where,
                         fmt::format("element <{}> is not {} {}{}", element.tag, rule ? "allowed" : "known", place,
                                     suggest(element.tag, tagsAllowedIn(parentRule))));
    }
    std::vector<std::string> allowed = rule->required;
    allowed.insert(allowed.end(), rule->optional.begin(), rule->optional.end());
    for (const XmlAttribute& attribute : element.attributes)
        if (std::ranges::find(allowed, attribute.name) == allowed.end())
            throw InputError(attribute.nameWhere, fmt::format("<{}> has no attribute \"{}\"{}", element.tag,
                                                              attribute.name, suggest(attribute.name, allowed)));
    for (const std::string& name : rule->required) element.require(name);
}

}  // namespace parhelion
