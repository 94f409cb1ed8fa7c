#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_tree.h"

namespace parhelion {

/// Limits a number must respect, and how a message says so.
struct NumberRange {
    double least;
    double most;
    bool leastExcluded = false;
    bool mostExcluded = false;
    const char* text;  ///< "must be ..."

    bool contains(double value) const;
};

inline constexpr NumberRange kAnyNumber{-1e300, 1e300, false, false, "be finite"};
inline constexpr NumberRange kNonNegative{0.0, 1e30, false, false, "be in [0, 1e30]"};
inline constexpr NumberRange kPositive{0.0, 1e30, true, false, "be in (0, 1e30]"};
inline constexpr NumberRange kUnitInterval{0.0, 1.0, false, false, "be in [0, 1]"};

/// What a colour is for: a <spectrum> of one number is grey, but the light of an emitter with it has the colour of
/// equal energy, as in Mitsuba's RGB variants.
enum class ColorRole { Value, Emission };

/// One object's properties, by name and type. Whatever nobody asked for is an error at finish().
class PropertyReader {
public:
    /// An object nested in another one, written there or referred to.
    struct Nested {
        std::string name;  ///< its role ("interior"), or empty
        const XmlElement* element;
        SourceLocation where;  ///< of the object, or of the <ref>
    };

    /// A <transform> and where it was written.
    struct Transform {
        glm::dmat4 matrix{1.0};
        SourceLocation where;
    };

    /// @throws InputError for undefined references and names given twice.
    PropertyReader(const SceneTree& tree, const XmlElement& object);

    const SceneTree& tree() const { return tree_; }
    const std::string& type() const { return object_.require("type").value; }
    std::string id() const;
    const SourceLocation& where() const { return object_.where; }
    /// Of a property's value; of the object if it has no such property.
    SourceLocation whereOf(std::string_view name) const;

    /// Whether the property was given. Messages list its name from then on, but it is still to be asked for.
    bool has(std::string_view name);
    /// The same for a property that is of no use here, whatever its type; it counts as asked for.
    bool accept(std::string_view name);

    /// Each returns `fallback` if the property was not given.
    /// @throws InputError at the value if it is of another type or out of range.
    double number(std::string_view name, double fallback, const NumberRange& range = kAnyNumber);
    std::int64_t integer(std::string_view name, std::int64_t fallback, std::int64_t least, std::int64_t most);
    bool boolean(std::string_view name, bool fallback);
    /// One of `allowed`.
    std::string choice(std::string_view name, const std::string& fallback, const std::vector<std::string>& allowed);
    /// One of `allowed`, which are in lower case; the file may use capitals.
    std::string choiceInAnyCase(std::string_view name, const std::string& fallback,
                                const std::vector<std::string>& allowed);
    /// From <rgb>, <spectrum> (constant), <float> or <integer>; in Nori's dialect from <color>, <float> or <integer>.
    glm::dvec3 color(std::string_view name, double fallback, const NumberRange& range,
                     ColorRole role = ColorRole::Value);
    /// From <point> or <vector>.
    glm::dvec3 triple(std::string_view name, glm::dvec3 fallback);
    Transform transform(std::string_view name);
    Transform flatTransform(std::string_view name);  ///< which need not be invertible

    /// The string property, or null. The pointer lives as long as the tree.
    const XmlAttribute* text(std::string_view name);
    /// The file that the (required) string property names.
    std::filesystem::path file(std::string_view name);

    /// All nested objects of one kind ("bsdf", "medium", ...).
    std::vector<Nested> nested(std::string_view tag);
    /// The only nested object of that kind, or nothing.
    /// @throws InputError at the second one.
    std::optional<Nested> onlyNested(std::string_view tag);
    /// The nested object with that name and kind, or nothing.
    std::optional<Nested> namedNested(std::string_view name, std::string_view tag);

    /// @throws InputError at the first property or nested object that nobody asked for, naming the nearest one.
    void finish() const;
    /// @throws InputError saying that the plugin is not one of `supported`.
    [[noreturn]] void rejectType(const std::vector<std::string>& supported) const;
    /// @throws InputError `where: <tag> "<id or type>": message`.
    [[noreturn]] void fail(const SourceLocation& where, std::string_view message) const;

private:
    struct Entry {
        std::string name;
        const XmlElement* element;  ///< the property, or the nested object
        SourceLocation where;
        bool used = false;
    };

    void checkNamesDiffer() const;
    const Entry* find(std::string_view name) const;
    void remember(std::string_view name);
    /// The property's element if given; marks it as used. Its tag must be one of `tags`.
    const XmlElement* take(std::string_view name, const std::vector<std::string_view>& tags);
    void checkRange(const XmlElement& property, std::string_view name, double value, const NumberRange& range) const;

    const SceneTree& tree_;
    const XmlElement& object_;
    std::vector<Entry> entries_;
    std::vector<std::string> known_;         ///< property names asked for so far
    std::vector<std::string> knownObjects_;  ///< kinds of nested objects asked for so far
};

}  // namespace parhelion
