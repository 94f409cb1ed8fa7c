#include "scene/obj_text.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "base/text_encoding.h"
#include "scene/attribute_values.h"
#include "scene/obj_remainder.h"
#include "scene/obj_statements.h"

namespace parhelion {
namespace {

/// The number for tinyobjloader, whose own reading goes wrong for many digits and for large exponents.
void appendNumber(std::string& text, std::string_view word, double value) {
    constexpr std::size_t kManyDigits = 32;
    const bool isPlain = word.size() <= kManyDigits && word.find_first_of("eE") == std::string_view::npos;
    const double size = std::abs(value);
    if (isPlain || (word.size() <= kManyDigits && size > 1e-30 && size < 1e30))
        text.append(" ").append(word);
    else
        fmt::format_to(std::back_inserter(text), " {}", static_cast<float>(value));
}

class ObjChecker {
public:
    explicit ObjChecker(const std::string& file) : remainder_(file) { result_.file = file; }

    void check(std::span<const ObjWord> words) {
        const std::string_view keyword = words[0].text;
        if (keyword == "v")
            checkVertex(words);
        else if (keyword == "vt")
            checkNumbers(words, 1, 1, "a texture coordinate");
        else if (keyword == "vn")
            checkNumbers(words, 2, 3, "a normal");
        else if (keyword == "f" || keyword == "fo")  // the older name
            checkFace(words);
        else
            remainder_.add(words);
    }

    ObjText finish() {
        for (std::size_t kind = 0; kind < 3; ++kind)
            if (largest_[kind] > counts_[kind])
                fail(largestWhere_[kind], fmt::format("{} index {} is past the end: the file has {}", kNames[kind],
                                                      largest_[kind], counts_[kind]));
        result_.notes = remainder_.notes();
        if (result_.faces.empty())
            throw InputError(SourceLocation{result_.file},
                             "an OBJ file needs faces (f); got none" + remainder_.unknownWords());
        return std::move(result_);
    }

private:
    static constexpr std::array kNames{"vertex", "texture coordinate", "normal"};

    [[noreturn]] void fail(const ObjWord& word, const std::string& message) const {
        throw InputError(SourceLocation{result_.file, word.line, word.column}, message);
    }

    void checkVertex(std::span<const ObjWord> words) {
        checkNumbers(words, 0, 3, "a vertex");
        remainder_.addVertex(words);
    }

    /// A coordinate of that kind; further words of the statement (weights, colours) must be numbers as well.
    void checkNumbers(std::span<const ObjWord> words, std::size_t kind, std::size_t least, std::string_view what) {
        result_.geometry.append(words[0].text);
        for (const ObjWord& word : words.subspan(1)) {
            const double value = numberOrNan(word.text);
            if (!(std::abs(value) <= std::numeric_limits<float>::max()))
                fail(word, fmt::format("{} must have finite numbers (32 bit); got \"{:.40}\"", what, word.text));
            appendNumber(result_.geometry, word.text, value);
        }
        if (words.size() - 1 < least)
            fail(words[0], fmt::format("{} needs {} numbers; got {}", what, least, words.size() - 1));
        result_.geometry.push_back('\n');
        ++counts_[kind];
    }

    void checkFace(std::span<const ObjWord> words) {
        result_.faces.push_back({words[0].line, words[0].column});
        result_.geometry.append("f");
        for (const ObjWord& word : words.subspan(1)) {
            checkCorner(word);
            // "1//" is "1": what is left out at the end needs no slashes.
            const std::string_view corner = word.text.substr(0, word.text.find_last_not_of('/') + 1);
            result_.geometry.append(" ").append(corner);
        }
        if (words.size() < 4) fail(words[0], fmt::format("a face needs at least 3 corners; got {}", words.size() - 1));
        result_.geometry.push_back('\n');
    }

    /// "v", "v/vt", "v//vn" or "v/vt/vn"; texture coordinate and normal may be missing behind their slash.
    void checkCorner(const ObjWord& word) {
        std::string_view rest = word.text;
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const std::size_t slash = std::min(rest.find('/'), rest.size());
            if (slash > 0 || kind == 0) checkIndex(rest.substr(0, slash), kind, word);
            if (slash == rest.size()) return;
            rest.remove_prefix(slash + 1);
        }
        fail(word, fmt::format("a face corner is v, v/vt, v//vn or v/vt/vn; got \"{:.40}\"", word.text));
    }

    void checkIndex(std::string_view text, std::size_t kind, const ObjWord& word) {
        std::int32_t index = 0;
        if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
        if (error == std::errc::result_out_of_range)
            fail(word, fmt::format("{} index {:.40} is beyond what a mesh may have", kNames[kind], text));
        if (text.empty() || error != std::errc{} || end != text.data() + text.size() || index == 0)
            fail(word,
                 fmt::format("a {} index must be an integer other than 0; got \"{:.40}\"", kNames[kind], word.text));
        if (index < 0 && -std::int64_t{index} > counts_[kind])
            fail(word,
                 fmt::format("{} index {} reaches before the first of {} so far", kNames[kind], index, counts_[kind]));
        if (index <= largest_[kind]) return;
        largest_[kind] = index;
        largestWhere_[kind] = word;
    }

    ObjRemainder remainder_;
    ObjText result_;
    std::array<std::int64_t, 3> counts_{};
    // A face may name vertices further down, so the range is known only at the end.
    std::array<std::int64_t, 3> largest_{};
    std::array<ObjWord, 3> largestWhere_;
};

/// Other files for meshes, which end up here under a wrong name or by mistake.
std::string otherFormat(std::string_view text) {
    constexpr std::array<std::array<std::string_view, 2>, 9> kFormats{{{"ply", "a PLY mesh"},
                                                                       {"solid", "an STL mesh"},
                                                                       {"OFF", "an OFF mesh"},
                                                                       {"glTF", "a glTF scene"},
                                                                       {"Kaydara FBX", "an FBX scene"},
                                                                       {"BLENDER", "a Blender scene"},
                                                                       {"#usda", "a USD scene"},
                                                                       {"PXR-USDC", "a USD scene"},
                                                                       {"\x1c\x04", "a Mitsuba \"serialized\" mesh"}}};
    for (const auto& [magic, name] : kFormats)
        if (text.starts_with(magic)) return fmt::format("{}: convert it", name);
    if (text.starts_with("version https://git-lfs")) return "a Git LFS pointer: fetch the file that it stands for";
    if (text.starts_with('<')) return "XML or HTML";
    return whyNotUtf8(text);
}

}  // namespace

ObjText checkObjText(std::string_view text, const std::string& file) {
    if (const std::string other = otherFormat(text); !other.empty())
        throw InputError(SourceLocation{file},
                         fmt::format("an OBJ file is plain text (UTF-8) and needs faces (f); this is {}", other));
    ObjStatements statements(text);
    ObjChecker checker(file);
    for (std::vector<ObjWord> words; statements.next(words);) checker.check(words);
    return checker.finish();
}

}  // namespace parhelion
