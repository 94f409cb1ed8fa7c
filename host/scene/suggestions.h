#pragma once

#include <span>
#include <string>
#include <string_view>

namespace parhelion {

/// The entry of `allowed` that `name` is probably a misspelling of (least edit distance, at most a third of its
/// length or 2), or empty.
std::string nearestName(std::string_view name, std::span<const std::string> allowed);

/// For the end of a message about an unknown name: "; did you mean "x"? Allowed: a, b, c" (the hint only when there
/// is a near one).
std::string suggest(std::string_view name, std::span<const std::string> allowed);

}  // namespace parhelion
