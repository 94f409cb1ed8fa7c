#include "scene/attribute_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace parhelion {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kSpaces);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

[[noreturn]] void reject(const XmlAttribute& attribute, std::string_view expected) {
    throw InputError(attribute.where, fmt::format("expected {}; got \"{:.80}\"", expected, attribute.value));
}

double srgbToLinear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

glm::dvec3 parseHexColor(const XmlAttribute& attribute, std::string_view digits) {
    std::uint32_t bits = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
    if (digits.size() != 6 || error != std::errc{} || end != digits.data() + digits.size())
        reject(attribute, "a colour as \"#rrggbb\"");
    const auto channel = [bits](unsigned shift) { return srgbToLinear(((bits >> shift) & 0xffu) / 255.0); };
    return {channel(16), channel(8), channel(0)};
}

/// Of a number that from_chars calls out of range: zero (or what is left of it) if it is too small for a double, NaN
/// if it is too large. Streams, unlike from_chars, tell the two apart.
double outOfRange(std::string_view text) {
    std::istringstream stream{std::string(text)};
    stream.imbue(std::locale::classic());
    double number = 0.0;
    stream >> number;
    return stream.fail() ? std::numeric_limits<double>::quiet_NaN() : number;
}

}  // namespace

double numberOrNan(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars knows no plus
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (end != text.data() + text.size()) return std::numeric_limits<double>::quiet_NaN();
    if (error == std::errc::result_out_of_range) return outOfRange(text);
    return error == std::errc{} ? number : std::numeric_limits<double>::quiet_NaN();
}

double parseNumber(const XmlAttribute& attribute) {
    const double number = numberOrNan(attribute.value);
    if (!std::isfinite(number)) reject(attribute, "a finite number");
    return number;
}

std::int64_t parseInteger(const XmlAttribute& attribute) {
    const std::string_view text = trimmed(attribute.value);
    std::int64_t integer = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), integer);
    if (error != std::errc{} || end != text.data() + text.size()) reject(attribute, "an integer (64 bit)");
    return integer;
}

bool parseBoolean(const XmlAttribute& attribute) {
    std::string text(trimmed(attribute.value));
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (text != "true" && text != "false") reject(attribute, "\"true\" or \"false\"");
    return text == "true";
}

std::vector<double> parseNumbers(const XmlAttribute& attribute) {
    constexpr std::string_view kSeparators = ", \t\r\n";
    const std::string_view text = attribute.value;
    std::vector<double> numbers;
    for (std::size_t begin = text.find_first_not_of(kSeparators); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
        numbers.push_back(numberOrNan(text.substr(begin, end - begin)));
        if (!std::isfinite(numbers.back())) reject(attribute, "finite numbers");
        begin = text.find_first_not_of(kSeparators, end);
    }
    return numbers;
}

glm::dvec3 parseTriple(const XmlAttribute& attribute) {
    const std::vector<double> numbers = parseNumbers(attribute);
    if (numbers.size() != 3) reject(attribute, "three numbers");
    return {numbers[0], numbers[1], numbers[2]};
}

glm::dvec3 parseColor(const XmlAttribute& attribute) {
    const std::string_view text = trimmed(attribute.value);
    if (text.starts_with('#')) return parseHexColor(attribute, text.substr(1));
    const std::vector<double> numbers = parseNumbers(attribute);
    if (numbers.size() == 1) return glm::dvec3(numbers[0]);
    if (numbers.size() != 3) reject(attribute, "a colour: three numbers, one for grey, or \"#rrggbb\"");
    return {numbers[0], numbers[1], numbers[2]};
}

glm::dvec3 parseXyz(const XmlElement& element, std::optional<double> fallback) {
    glm::dvec3 result(fallback.value_or(0.0));
    const XmlAttribute* value = element.find("value");
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view name = std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1);
        const XmlAttribute* component = element.find(name);
        if (!component && !value && !fallback) component = &element.require(name);
        if (!component) continue;
        if (value)
            throw InputError(component->nameWhere,
                             fmt::format("<{}> takes either \"value\" or x, y and z, not both", element.tag));
        result[axis] = parseNumber(*component);
    }
    if (!value) return result;
    const std::vector<double> numbers = parseNumbers(*value);
    if (numbers.size() == 1) return glm::dvec3(numbers[0]);
    if (numbers.size() != 3) reject(*value, "three numbers, or one for all three");
    return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace parhelion
