#include "scene/property_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "scene/attribute_values.h"
#include "scene/scene_grammar.h"
#include "scene/suggestions.h"
#include "scene/transforms.h"

namespace parhelion {

bool NumberRange::contains(double value) const {
    return (leastExcluded ? value > least : value >= least) && (mostExcluded ? value < most : value <= most);
}

PropertyReader::PropertyReader(const SceneTree& tree, const XmlElement& object) : tree_(tree), object_(object) {
    for (const XmlElement& child : object.children) {
        const XmlAttribute* name = child.find("name");
        const XmlElement* element = child.tag == "ref" ? &tree.object(child.require("id")) : &child;
        entries_.push_back({name ? name->value : "", element, child.where});
    }
    checkNamesDiffer();
}

void PropertyReader::checkNamesDiffer() const {
    std::unordered_map<std::string_view, const Entry*> first;
    for (const Entry& entry : entries_) {
        if (entry.name.empty()) continue;
        const auto [earlier, isNew] = first.try_emplace(entry.name, &entry);
        if (!isNew)
            fail(entry.where,
                 fmt::format("\"{}\" is given twice, first at {}", entry.name, earlier->second->where.text()));
    }
}

std::string PropertyReader::id() const {
    const XmlAttribute* id = object_.find("id");
    return id ? id->value : "";
}

const PropertyReader::Entry* PropertyReader::find(std::string_view name) const {
    const auto found = std::ranges::find(entries_, name, &Entry::name);
    return found == entries_.end() ? nullptr : &*found;
}

bool PropertyReader::has(std::string_view name) {
    remember(name);
    return find(name) != nullptr;
}

bool PropertyReader::accept(std::string_view name) {
    remember(name);
    const auto entry = std::ranges::find(entries_, name, &Entry::name);
    if (entry == entries_.end()) return false;
    return entry->used = true;
}

SourceLocation PropertyReader::whereOf(std::string_view name) const {
    const Entry* entry = find(name);
    if (!entry) return object_.where;
    const XmlAttribute* value = entry->element->find("value");
    return value && isPropertyTag(entry->element->tag) ? value->where : entry->where;
}

void PropertyReader::remember(std::string_view name) {
    if (std::ranges::find(known_, name) == known_.end()) known_.emplace_back(name);
}

const XmlElement* PropertyReader::take(std::string_view name, const std::vector<std::string_view>& tags) {
    remember(name);
    const auto entry = std::ranges::find(entries_, name, &Entry::name);
    if (entry == entries_.end()) return nullptr;
    entry->used = true;
    const XmlElement& element = *entry->element;
    if (std::ranges::find(tags, element.tag) != tags.end()) return &element;
    if (element.tag == "texture")
        fail(entry->where, fmt::format("\"{}\" cannot be a texture; it takes <{}>", name, fmt::join(tags, ">, <")));
    fail(entry->where, fmt::format("\"{}\" must be a <{}>; got <{}>", name, fmt::join(tags, "> or <"), element.tag));
}

void PropertyReader::checkRange(const XmlElement& property, std::string_view name, double value,
                                const NumberRange& range) const {
    if (!range.contains(value))
        fail(property.require("value").where, fmt::format("\"{}\" must {}; got {}", name, range.text, value));
}

double PropertyReader::number(std::string_view name, double fallback, const NumberRange& range) {
    const XmlElement* property = take(name, {"float", "integer"});
    if (!property) return fallback;
    const double value = parseNumber(property->require("value"));
    checkRange(*property, name, value, range);
    return value;
}

std::int64_t PropertyReader::integer(std::string_view name, std::int64_t fallback, std::int64_t least,
                                     std::int64_t most) {
    const XmlElement* property = take(name, {"integer"});
    if (!property) return fallback;
    const std::int64_t value = parseInteger(property->require("value"));
    if (value < least || value > most)
        fail(property->require("value").where,
             fmt::format("\"{}\" must be in [{}, {}]; got {}", name, least, most, value));
    return value;
}

bool PropertyReader::boolean(std::string_view name, bool fallback) {
    const XmlElement* property = take(name, {"boolean"});
    return property ? parseBoolean(property->require("value")) : fallback;
}

std::string PropertyReader::choice(std::string_view name, const std::string& fallback,
                                   const std::vector<std::string>& allowed) {
    const XmlAttribute* value = text(name);
    if (!value) return fallback;
    if (std::ranges::find(allowed, value->value) == allowed.end())
        fail(value->where,
             fmt::format("\"{}\" cannot be \"{}\"{}", name, value->value, suggest(value->value, allowed)));
    return value->value;
}

std::string PropertyReader::choiceInAnyCase(std::string_view name, const std::string& fallback,
                                            const std::vector<std::string>& allowed) {
    const XmlAttribute* value = text(name);
    if (!value) return fallback;
    std::string lower = value->value;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (std::ranges::find(allowed, lower) == allowed.end())
        fail(value->where, fmt::format("\"{}\" cannot be \"{}\"{}", name, value->value, suggest(lower, allowed)));
    return lower;
}

glm::dvec3 PropertyReader::color(std::string_view name, double fallback, const NumberRange& range, ColorRole role) {
    // Light of equal energy at all wavelengths in linear Rec. 709, as Mitsuba 3.9.1 has it.
    constexpr glm::dvec3 kEqualEnergy{1.204793930053711, 0.948291003704071, 0.9089160561561584};
    std::vector<std::string_view> tags{"rgb", "float", "integer", "spectrum"};
    if (tree_.dialect() == Dialect::Nori) tags = {"color", "float", "integer"};
    const XmlElement* property = take(name, tags);
    if (!property) return glm::dvec3(fallback);
    const XmlAttribute& value = property->require("value");
    if (property->tag == "spectrum" && value.value.find(':') != std::string::npos)
        fail(value.where, fmt::format("\"{}\": spectra given by wavelength are not supported; use <rgb>, or one number "
                                      "for a constant spectrum",
                                      name));
    const bool isTriple = property->tag == "rgb" || property->tag == "color";
    const glm::dvec3 color = isTriple ? parseColor(value) : glm::dvec3(parseNumber(value));
    for (int channel = 0; channel < 3; ++channel) checkRange(*property, name, color[channel], range);
    return property->tag == "spectrum" && role == ColorRole::Emission ? kEqualEnergy * color : color;
}

glm::dvec3 PropertyReader::triple(std::string_view name, glm::dvec3 fallback) {
    const XmlElement* property = take(name, {"point", "vector"});
    return property ? parseXyz(*property, std::nullopt) : fallback;
}

PropertyReader::Transform PropertyReader::transform(std::string_view name) {
    const XmlElement* property = take(name, {"transform"});
    if (!property) return {glm::dmat4(1.0), object_.where};
    return {readTransform(*property), property->where};
}

PropertyReader::Transform PropertyReader::flatTransform(std::string_view name) {
    const XmlElement* property = take(name, {"transform"});
    if (!property) return {glm::dmat4(1.0), object_.where};
    return {readFlatTransform(*property), property->where};
}

const XmlAttribute* PropertyReader::text(std::string_view name) {
    const XmlElement* property = take(name, {"string"});
    return property ? &property->require("value") : nullptr;
}

std::filesystem::path PropertyReader::file(std::string_view name) {
    const XmlAttribute* value = text(name);
    if (!value) fail(object_.where, fmt::format("needs <string name=\"{}\">", name));
    if (value->value.empty()) fail(value->where, fmt::format("\"{}\" must name a file; got \"\"", name));
    return tree_.resolveFile(*value);
}

std::vector<PropertyReader::Nested> PropertyReader::nested(std::string_view tag) {
    knownObjects_.emplace_back(tag);
    std::vector<Nested> result;
    for (Entry& entry : entries_) {
        if (entry.element->tag != tag) continue;
        entry.used = true;
        result.push_back({entry.name, entry.element, entry.where});
    }
    return result;
}

std::optional<PropertyReader::Nested> PropertyReader::onlyNested(std::string_view tag) {
    const std::vector<Nested> all = nested(tag);
    if (all.empty()) return std::nullopt;
    if (all.size() > 1) fail(all[1].where, fmt::format("only one <{}> is allowed here", tag));
    return all.front();
}

std::optional<PropertyReader::Nested> PropertyReader::namedNested(std::string_view name, std::string_view tag) {
    remember(name);
    for (Entry& entry : entries_) {
        if (entry.element->tag != tag || entry.name != name) continue;
        entry.used = true;
        return Nested{entry.name, entry.element, entry.where};
    }
    return std::nullopt;
}

void PropertyReader::finish() const {
    const auto unknown = std::ranges::find(entries_, false, &Entry::used);
    if (unknown == entries_.end()) return;
    const std::string& tag = unknown->element->tag;
    if (!isObjectTag(tag))
        fail(unknown->where, fmt::format("unknown property \"{}\"{}", unknown->name, suggest(unknown->name, known_)));
    if (tag == "texture")
        fail(unknown->where, fmt::format("unknown property \"{}\"{}", unknown->name, suggest(unknown->name, known_)));
    if (!unknown->name.empty() && std::ranges::find(knownObjects_, tag) == knownObjects_.end())
        fail(unknown->where,
             fmt::format("<{}> \"{}\" is not allowed here{}", tag, unknown->name, suggest(unknown->name, known_)));
    fail(unknown->where, fmt::format("<{}> is not allowed here{}", tag, suggest(tag, knownObjects_)));
}

void PropertyReader::rejectType(const std::vector<std::string>& supported) const {
    throw InputError(object_.require("type").where, fmt::format("{} plugin \"{}\" is not supported{}", object_.tag,
                                                                type(), suggest(type(), supported)));
}

void PropertyReader::fail(const SourceLocation& where, std::string_view message) const {
    const std::string name = id().empty() ? type() : id();
    throw InputError(where, fmt::format("{} \"{}\": {}", object_.tag, name, message));
}

}  // namespace parhelion
