#include "base/error.h"

#include <fmt/format.h>

namespace parhelion {

std::string SourceLocation::text() const { return line > 0 ? fmt::format("{}:{}:{}", file, line, column) : file; }

}  // namespace parhelion
