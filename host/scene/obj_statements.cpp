#include "scene/obj_statements.h"

#include <algorithm>

#include "base/text_encoding.h"

namespace parhelion {
namespace {

constexpr std::string_view kSpaces = " \t\v\f";

/// Whether what is named may end in a backslash of its own (`mtllib C:\models\`).
bool isNameStatement(std::string_view keyword) {
    return keyword == "g" || keyword == "o" || keyword == "usemtl" || keyword == "mtllib";
}

bool isStatement(std::string_view keyword) {
    constexpr std::string_view kStatements[] = {"v", "vt", "vn", "vp", "f", "l", "p", "s"};
    return isNameStatement(keyword) || std::ranges::find(kStatements, keyword) != std::end(kStatements);
}

/// Whether the # in it begins a comment: not in a name (`usemtl wood#2`), nor in what a C library writes for NaN and
/// infinity (`1.#QNAN`, `-1.#IND00`, `1.#INF`).
bool isComment(std::string_view line, std::size_t at, bool isName) {
    if (at == 0 || kSpaces.find(line[at - 1]) != std::string_view::npos) return true;
    const std::string_view rest = line.substr(at + 1);
    const bool isNoNumber = rest.starts_with("IN") || rest.starts_with("QNAN") || rest.starts_with("SNAN");
    return !isName && !(line[at - 1] == '.' && isNoNumber);
}

std::string_view withoutComment(std::string_view line, bool isName) {
    std::size_t at = line.find('#');
    while (at != std::string_view::npos && !isComment(line, at, isName)) at = line.find('#', at + 1);
    return line.substr(0, at);
}

std::string_view firstWord(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
    return text.substr(0, text.find_first_of(" \t\v\f\r\n"));
}

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
    const bool isName = isNameStatement(words.empty() ? firstWord(line) : words.front().text);
    line = withoutComment(line, isName);
    line = line.substr(0, line.find_last_not_of(kSpaces) + 1);
    const bool goesOn = line.ends_with('\\') && !(isName && isStatement(firstWord(rest_)));
    if (goesOn) line.remove_suffix(1);
    for (std::size_t begin = line.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kSpaces, begin), line.size());
        words.push_back({line.substr(begin, end - begin), line_, static_cast<int>(begin) + 1});
        begin = line.find_first_not_of(kSpaces, end);
    }
    return goesOn;
}

}  // namespace parhelion
