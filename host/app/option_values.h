#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/film.h"

namespace parhelion::app {

/// The largest film the command line accepts, pixels per axis.
inline constexpr std::uint32_t kMaxFilmSize = 65536;

/// The values of options, from text. Each throws InputError "option: expected ...; got ..." and accepts nothing
/// before or after the value. `option` is its name as the user writes it.

/// A whole number in [minimum, maximum].
std::int64_t parseInteger(const std::string& option, const std::string& text, std::int64_t minimum,
                          std::int64_t maximum);
/// A finite number in [minimum, maximum].
double parseNumber(const std::string& option, const std::string& text, double minimum, double maximum);
/// "1%", "0.5 %" or "0.01": a share of 1, at most 100 % and at least 0.0002 %, twice what single precision may do.
double parseShare(const std::string& option, const std::string& text);
/// "30s", "5m", "2h" or "30": seconds, above 0.
double parseSeconds(const std::string& option, const std::string& text);
/// "WIDTHxHEIGHT", each 1..kMaxFilmSize.
glm::uvec2 parseSize(const std::string& option, const std::string& text);
/// "X,Y,WIDTHxHEIGHT": a non-empty rectangle of pixels, origin at the top left.
PixelRect parseCrop(const std::string& option, const std::string& text);
/// "name=value"; the value may be empty and may hold further "=".
std::pair<std::string, std::string> parseDefine(const std::string& option, const std::string& text);

}  // namespace parhelion::app
