#pragma once

#include <string>
#include <string_view>

namespace parhelion {

/// Removes the byte order mark that some editors put before UTF-8.
std::string_view withoutByteOrderMark(std::string_view text);

/// What keeps the bytes of a file from being read as UTF-8 text, and what to do about it, as the end of a sentence
/// ("UTF-16 text: save it as UTF-8"); empty for text. Known are UTF-16 and UTF-32, with or without byte order mark,
/// and the usual kinds of compression; everything else with a zero byte is called binary.
std::string whyNotUtf8(std::string_view bytes);

}  // namespace parhelion
