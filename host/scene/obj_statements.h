#pragma once

#include <string_view>
#include <vector>

namespace parhelion {

/// A word of an OBJ file and where it stands, both counted from 1.
struct ObjWord {
    std::string_view text;
    int line = 1, column = 1;
};

/// Cuts an OBJ text into statements of words. Lines end with \n, \r\n or \r; a backslash as the last character of a
/// line but for spaces joins the next one to it, as a space would. What follows a # is left out, a backslash there as
/// well: comments hold Windows paths, and must not swallow a line. A byte order mark before a line is skipped, which
/// joined files have in their middle.
class ObjStatements {
public:
    /// @param text  must outlive the words.
    explicit ObjStatements(std::string_view text) : rest_(text) {}

    /// Takes the next statement that has words.
    ///
    /// @param words  replaced; the first one is the keyword.
    /// @return false at the end of the text.
    bool next(std::vector<ObjWord>& words);

private:
    std::string_view takeLine();
    bool addWords(std::vector<ObjWord>& words);

    std::string_view rest_;
    int line_ = 0;
};

}  // namespace parhelion
