#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/obj_statements.h"

namespace parhelion {

/// Keeps count of what an OBJ file holds and nothing here uses.
class ObjRemainder {
public:
    explicit ObjRemainder(std::string file) : file_(std::move(file)) {}

    /// A statement other than v, vt, vn and f.
    void add(std::span<const ObjWord> words);

    /// A vertex, whose fourth number is a weight, and the last three of six or more a colour.
    void addVertex(std::span<const ObjWord> words);

    /// What a user should know of, located at the first of its kind.
    std::vector<std::string> notes() const;

    /// Half a sentence about words that no OBJ statement starts with, or nothing.
    std::string unknownWords() const;

private:
    struct Count {
        std::uint64_t number = 0;
        ObjWord first;

        void add(const ObjWord& word) {
            if (number++ == 0) first = word;
        }
    };
    struct Keywords {
        std::map<std::string, std::uint64_t, std::less<>> numbers;
        ObjWord first;

        void add(const std::string& keyword, const ObjWord& word);
        std::string list() const;
    };

    std::string at(const ObjWord& word, const std::string& message) const;

    std::string file_;
    Keywords shapes_, unknown_;
    Count colors_, weights_;
    std::set<std::string, std::less<>> materials_;
    std::optional<ObjWord> secondMaterial_;
};

}  // namespace parhelion
