#include "scene/obj_remainder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/attribute_values.h"

namespace parhelion {
namespace {

/// Statements with geometry other than polygons, or that bring it from elsewhere.
constexpr std::array<std::string_view, 12> kShapes{"p",   "l",   "curv", "curv2", "surf", "bsp",
                                                   "bzp", "cdc", "cdp",  "res",   "call", "csh"};

/// Statements that say nothing about where polygons are: names, looks, and the parts of curves and surfaces.
constexpr std::array<std::string_view, 30> kSilent{
    "o",    "g",          "s",         "mg",    "mtllib", "maplib", "usemap", "bevel",  "c_interp", "d_interp",
    "lod",  "shadow_obj", "trace_obj", "ctech", "stech",  "vp",     "cstype", "deg",    "bmat",     "step",
    "parm", "trim",       "hole",      "scrv",  "sp",     "end",    "con",    "usemtl", "newmtl",   "bmtl"};

/// The beginning of a word, fit to be printed.
std::string printable(std::string_view word) {
    std::string text(word.substr(0, 20));
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

}  // namespace

void ObjRemainder::add(std::span<const ObjWord> words) {
    const std::string_view keyword = words[0].text;
    if (keyword == "usemtl" && words.size() > 1 && materials_.emplace(words[1].text).second && materials_.size() == 2)
        secondMaterial_ = words[0];
    if (std::ranges::find(kShapes, keyword) != kShapes.end())
        shapes_.add(std::string(keyword), words[0]);
    else if (std::ranges::find(kSilent, keyword) == kSilent.end())
        unknown_.add(printable(keyword), words[0]);
}

void ObjRemainder::addVertex(std::span<const ObjWord> words) {
    const std::size_t numbers = words.size() - 1;
    if (numbers >= 6) colors_.add(words[0]);
    if ((numbers == 4 || numbers == 5) && numberOrNan(words[4].text) != 1.0) weights_.add(words[0]);
}

std::vector<std::string> ObjRemainder::notes() const {
    std::vector<std::string> notes;
    if (colors_.number > 0)
        notes.push_back(at(colors_.first, fmt::format("the colours of {} vertices are left out", colors_.number)));
    if (weights_.number > 0)
        notes.push_back(at(weights_.first, fmt::format("the weights of {} vertices are left out", weights_.number)));
    if (secondMaterial_)
        notes.push_back(at(*secondMaterial_, fmt::format("the {} materials (usemtl) are left out: a shape has one BSDF",
                                                         materials_.size())));
    if (!shapes_.numbers.empty())
        notes.push_back(at(shapes_.first, fmt::format("only polygons (f) are read; left out: {}", shapes_.list())));
    if (!unknown_.numbers.empty())
        notes.push_back(
            at(unknown_.first, fmt::format("statements that OBJ does not have are left out: {}", unknown_.list())));
    return notes;
}

std::string ObjRemainder::unknownWords() const {
    return unknown_.numbers.empty() ? "" : fmt::format("; its lines start with {}", unknown_.list());
}

void ObjRemainder::Keywords::add(const std::string& keyword, const ObjWord& word) {
    if (numbers.empty()) first = word;
    ++numbers[keyword];
}

/// The keywords with their numbers of statements.
std::string ObjRemainder::Keywords::list() const {
    constexpr std::size_t kMost = 8;
    std::string text;
    std::size_t listed = 0;
    for (const auto& [keyword, number] : numbers) {
        if (listed++ == kMost) return text + ", ...";
        text += fmt::format("{}\"{}\" ({})", text.empty() ? "" : ", ", keyword, number);
    }
    return text;
}

std::string ObjRemainder::at(const ObjWord& word, const std::string& message) const {
    return fmt::format("{}: {}", SourceLocation{file_, word.line, word.column}.text(), message);
}

}  // namespace parhelion
