#include "scene/obj_statements.h"

#include <algorithm>

#include "base/text_encoding.h"

namespace parhelion {
namespace {

constexpr std::string_view kSpaces = " \t\v\f";

}  // namespace

bool ObjStatements::next(std::vector<ObjWord>& words) {
    words.clear();
    while (words.empty() && !rest_.empty())
        while (addWords(words) && !rest_.empty()) continue;
    return !words.empty();
}

std::string_view ObjStatements::takeLine() {
    ++line_;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    const bool pair = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (pair ? 2 : 1), rest_.size()));
    return withoutByteOrderMark(line);
}

/// Adds a line's words. Returns whether the statement goes on in the next line.
bool ObjStatements::addWords(std::vector<ObjWord>& words) {
    std::string_view line = takeLine();
    line = line.substr(0, line.find('#'));
    line = line.substr(0, line.find_last_not_of(kSpaces) + 1);
    const bool goesOn = line.ends_with('\\');
    if (goesOn) line.remove_suffix(1);
    for (std::size_t begin = line.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kSpaces, begin), line.size());
        words.push_back({line.substr(begin, end - begin), line_, static_cast<int>(begin) + 1});
        begin = line.find_first_not_of(kSpaces, end);
    }
    return goesOn;
}

}  // namespace parhelion
