#include "gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "gpu/pipeline.h"

namespace parhelion::gpu {
namespace fs = std::filesystem;
namespace {

std::string readText(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in.is_open() || !fs::is_regular_file(file))
        throw RuntimeFailure(fmt::format("{}: cannot read this shader", file.string()));
    return {std::istreambuf_iterator<char>(in), {}};
}

/// X of a line `#include "X"`, blanks allowed where the preprocessor allows them.
std::optional<std::string> includedName(std::string_view line) {
    const auto skipBlanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    const auto skip = [&](std::string_view token) {
        skipBlanks();
        if (!line.starts_with(token)) return false;
        line.remove_prefix(token.size());
        return true;
    };
    if (!skip("#") || !skip("include") || !skip("\"")) return std::nullopt;
    const std::size_t end = line.find('"');
    if (end == std::string_view::npos) return std::nullopt;
    return std::string(line.substr(0, end));
}

class Collector {
public:
    SourceFiles files;

    void visit(const fs::path& file) {
        stack_.push_back(file);
        if (const auto [entry, isNew] = files.try_emplace(file.string()); isNew) {
            entry->second = readText(file);
            visitIncludes(file, entry->second);
        }
        stack_.pop_back();
    }

private:
    void visitIncludes(const fs::path& file, const std::string& text) {
        std::istringstream lines(text);
        int number = 0;
        for (std::string line; std::getline(lines, line);) {
            ++number;
            const std::optional<std::string> name = includedName(line);
            const fs::path included = name ? resolveInclude(file, *name) : fs::path();
            if (included.empty()) continue;
            if (std::find(stack_.begin(), stack_.end(), included) != stack_.end())
                throw RuntimeFailure(fmt::format("{}:{}: this file is part of what \"{}\" includes: a cycle",
                                                 file.string(), number, *name));
            visit(included);
        }
    }

    std::vector<fs::path> stack_;  ///< from the shader to the file being read
};

}  // namespace

fs::path resolveInclude(const fs::path& includer, std::string_view name) {
    for (const fs::path& folder : {includer.parent_path(), shaderFolder()}) {
        const fs::path candidate = (folder / name).lexically_normal();
        if (fs::is_regular_file(candidate)) return candidate;
    }
    return {};
}

SourceFiles readSources(const fs::path& shader) {
    Collector collector;
    collector.visit(shader);
    return std::move(collector.files);
}

}  // namespace parhelion::gpu
