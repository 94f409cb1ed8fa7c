#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace parhelion {

/// Where a value was written: file, 1-based line and column; line 0: the file as a whole.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;

    /// "file:line:column", or "file" when line is 0.
    std::string text() const;
};

/// Bad input by a user: what() is "file:line:column: what is wrong, what is allowed; got ...".
/// main() turns it into exit code 2.
class InputError : public std::runtime_error {
public:
    InputError(const SourceLocation& where, const std::string& message)
        : std::runtime_error(where.text() + ": " + message), where_(where) {}
    /// For errors of the command line, which have no file.
    explicit InputError(const std::string& message) : std::runtime_error(message) {}

    const SourceLocation& where() const { return where_; }

private:
    SourceLocation where_;
};

/// Running out of a resource or a failing device: exit code 3.
class RuntimeFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace parhelion
