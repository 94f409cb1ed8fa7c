#include "scene/obj_text.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scene/attribute_values.h"

namespace parhelion {
namespace {

constexpr std::string_view kSpaces = " \t";

/// One line, cut into words from the left.
class Words {
public:
    Words(std::string_view line, const SourceLocation& where) : line_(line), where_(where) {}

    /// The next word, or empty at the end.
    std::string_view next() {
        begin_ = std::min(line_.find_first_not_of(kSpaces, end_), line_.size());
        end_ = std::min(line_.find_first_of(kSpaces, begin_), line_.size());
        return line_.substr(begin_, end_ - begin_);
    }

    /// Of the word that next() returned last.
    SourceLocation where() const { return {where_.file, where_.line, static_cast<int>(begin_) + 1}; }

private:
    std::string_view line_;
    SourceLocation where_;
    std::size_t begin_ = 0, end_ = 0;
};

class ObjChecker {
public:
    explicit ObjChecker(const std::string& file) { where_.file = file; }

    void checkLine(std::string_view line) {
        ++where_.line;
        Words words(line, where_);
        const std::string_view keyword = words.next();
        if (keyword == "v") {
            checkNumbers(words, 3, "a vertex");
            ++counts_[0];
        } else if (keyword == "vt") {
            checkNumbers(words, 1, "a texture coordinate");
            ++counts_[1];
        } else if (keyword == "vn") {
            checkNumbers(words, 3, "a normal");
            ++counts_[2];
        } else if (keyword == "f") {
            result_.faces.push_back(words.where());
            checkFace(words);
        } else {
            return;
        }
        result_.geometry.append(line).push_back('\n');
    }

    ObjText finish() {
        for (std::size_t kind = 0; kind < 3; ++kind)
            if (largest_[kind] > counts_[kind])
                throw InputError(largestWhere_[kind], fmt::format("{} index {} is past the end: the file has {}",
                                                                  kNames[kind], largest_[kind], counts_[kind]));
        if (result_.faces.empty())
            throw InputError(SourceLocation{where_.file}, "an OBJ file needs faces (f); got none");
        return std::move(result_);
    }

private:
    static constexpr std::array kNames{"vertex", "texture coordinate", "normal"};

    /// A coordinate; further words on the line (weights, colours) must be numbers as well.
    void checkNumbers(Words& words, int least, std::string_view what) {
        int count = 0;
        for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++count) {
            const double value = numberOrNan(word);
            if (!(std::abs(value) <= std::numeric_limits<float>::max()))
                throw InputError(words.where(),
                                 fmt::format("{} must have finite numbers (32 bit); got \"{:.40}\"", what, word));
        }
        if (count < least) throw InputError(where_, fmt::format("{} needs {} numbers; got {}", what, least, count));
    }

    void checkFace(Words& words) {
        int corners = 0;
        for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corners)
            checkCorner(word, words.where());
        if (corners < 3) throw InputError(where_, fmt::format("a face needs at least 3 corners; got {}", corners));
    }

    /// "v", "v/vt", "v//vn" or "v/vt/vn".
    void checkCorner(std::string_view word, const SourceLocation& where) {
        std::string_view rest = word;
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const std::size_t slash = std::min(rest.find('/'), rest.size());
            const bool skipped = kind == 1 && slash == 0 && rest.size() > 1;  // v//vn
            if (!skipped) checkIndex(rest.substr(0, slash), kind, word, where);
            if (slash == rest.size()) return;
            rest.remove_prefix(slash + 1);
        }
        throw InputError(where, fmt::format("a face corner is v, v/vt, v//vn or v/vt/vn; got \"{:.40}\"", word));
    }

    void checkIndex(std::string_view text, std::size_t kind, std::string_view word, const SourceLocation& where) {
        std::int32_t index = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
        if (text.empty() || error != std::errc{} || end != text.data() + text.size() || index == 0)
            throw InputError(
                where, fmt::format("a {} index must be an integer other than 0; got \"{:.40}\"", kNames[kind], word));
        if (index < 0 && -std::int64_t{index} > counts_[kind])
            throw InputError(where, fmt::format("{} index {} reaches before the first of {} so far", kNames[kind],
                                                index, counts_[kind]));
        if (index <= largest_[kind]) return;
        largest_[kind] = index;
        largestWhere_[kind] = where;
    }

    SourceLocation where_{"", 0, 1};
    ObjText result_;
    std::array<std::int64_t, 3> counts_{};
    // A face may name vertices further down, so the range is known only at the end.
    std::array<std::int64_t, 3> largest_{};
    std::array<SourceLocation, 3> largestWhere_;
};

}  // namespace

ObjText checkObjText(std::string_view text, const std::string& file) {
    ObjChecker checker(file);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        checker.checkLine(text.substr(0, end));
        const bool pair = text.substr(end).starts_with("\r\n");
        text.remove_prefix(std::min(end + (pair ? 2 : 1), text.size()));
    }
    return checker.finish();
}

}  // namespace parhelion
