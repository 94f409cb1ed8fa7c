#include "app/output_check.h"

#include <fmt/format.h>

#include <system_error>

#include "base/error.h"

namespace parhelion::app {

namespace {

namespace fs = std::filesystem;

bool areSame(const fs::path& a, const fs::path& b) {
    std::error_code error;  // a file that cannot be looked up is no file that could be replaced
    return fs::equivalent(a, b, error) ||
           fs::weakly_canonical(fs::absolute(a), error) == fs::weakly_canonical(fs::absolute(b), error);
}

}  // namespace

void refuseReplacing(std::span<const fs::path> inputs, const fs::path& output, const std::string& option) {
    for (const fs::path& input : inputs)
        if (areSame(input, output))
            throw InputError(fmt::format("{}: {} would replace {}, which is read; give another name", option,
                                         output.string(), input.string()));
}

}  // namespace parhelion::app
