#include "app/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace parhelion::app {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& expected, const std::string& text) {
    throw InputError(fmt::format("{}: expected {}; got {}", option, expected, text.empty() ? "nothing" : text));
}

/// The number that is the whole of text.
template <typename Number>
std::optional<Number> readWhole(std::string_view text) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    return value;
}

/// Splits at the first separator; nothing when there is none.
std::optional<std::pair<std::string_view, std::string_view>> splitAt(std::string_view text, char separator) {
    const std::size_t at = text.find(separator);
    if (at == std::string_view::npos) return std::nullopt;
    return std::pair(text.substr(0, at), text.substr(at + 1));
}

std::optional<glm::uvec2> readPair(std::string_view text, char separator, std::uint32_t minimum,
                                   std::uint32_t maximum) {
    const auto parts = splitAt(text, separator);
    if (!parts) return std::nullopt;
    const auto x = readWhole<std::uint32_t>(parts->first);
    const auto y = readWhole<std::uint32_t>(parts->second);
    if (!x || !y || std::min(*x, *y) < minimum || std::max(*x, *y) > maximum) return std::nullopt;
    return glm::uvec2(*x, *y);
}

}  // namespace

std::int64_t parseInteger(const std::string& option, const std::string& text, std::int64_t minimum,
                          std::int64_t maximum) {
    const auto value = readWhole<std::int64_t>(text);
    if (!value || *value < minimum || *value > maximum)
        refuse(option, fmt::format("a whole number from {} to {}", minimum, maximum), text);
    return *value;
}

double parseNumber(const std::string& option, const std::string& text, double minimum, double maximum) {
    const auto value = readWhole<double>(text);
    if (!value || !(*value >= minimum && *value <= maximum))
        refuse(option, fmt::format("a number from {} to {}", minimum, maximum), text);
    return *value;
}

double parseShare(const std::string& option, const std::string& text) {
    std::string_view number = text;
    double unit = 1;
    if (number.ends_with('%')) {
        number.remove_suffix(1);
        if (number.ends_with(' ')) number.remove_suffix(1);
        unit = 0.01;
    }
    const auto value = readWhole<double>(number);
    if (!value || !(*value * unit >= 2e-6 && *value * unit <= 1))
        refuse(option, "a share as 1%, 0.5% or 0.01, from 0.0002% to 100%", text);
    return *value * unit;
}

double parseSeconds(const std::string& option, const std::string& text) {
    std::string_view number = text;
    double unit = 1;
    for (const auto& [suffix, seconds] : {std::pair('s', 1.0), {'m', 60.0}, {'h', 3600.0}})
        if (number.ends_with(suffix)) {
            number.remove_suffix(1);
            unit = seconds;
            break;
        }
    const auto value = readWhole<double>(number);
    if (!value || !(*value * unit >= 0.01 && *value * unit <= 1e7))
        refuse(option, "a time as 30s, 5m or 2h, from 0.01s to 1e7s", text);
    return *value * unit;
}

glm::uvec2 parseSize(const std::string& option, const std::string& text) {
    const auto size = readPair(text, 'x', 1, kMaxFilmSize);
    if (!size) refuse(option, fmt::format("WIDTHxHEIGHT, each 1..{}", kMaxFilmSize), text);
    return *size;
}

PixelRect parseCrop(const std::string& option, const std::string& text) {
    // The second comma ends the offset.
    const std::size_t comma = text.find(',', text.find(',') + 1);
    const auto offset = readPair(text.substr(0, comma), ',', 0, kMaxFilmSize - 1);
    const auto size =
        comma == std::string::npos ? std::nullopt : readPair(text.substr(comma + 1), 'x', 1, kMaxFilmSize);
    if (!offset || !size)
        refuse(option,
               fmt::format("X,Y,WIDTHxHEIGHT, X and Y 0..{}, WIDTH and HEIGHT 1..{}", kMaxFilmSize - 1, kMaxFilmSize),
               text);
    return {*offset, *size};
}

std::pair<std::string, std::string> parseDefine(const std::string& option, const std::string& text) {
    const auto parts = splitAt(text, '=');
    if (!parts || parts->first.empty()) refuse(option, "name=value", text);
    return {std::string(parts->first), std::string(parts->second)};
}

}  // namespace parhelion::app
