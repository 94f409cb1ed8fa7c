#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace parhelion::gpu {

/// The file an #include names: beside the including file, else below shaderFolder(). Normalised; empty when missing.
std::filesystem::path resolveInclude(const std::filesystem::path& includer, std::string_view name);

/// A shader and every file it includes, by path as resolveInclude gives it.
using SourceFiles = std::map<std::string, std::string>;

/// Reads a shader and all its quoted includes, those in inactive branches too; includes that are missing are left to
/// the compiler, which knows whether they matter. @throws RuntimeFailure for an unreadable shader or an include cycle.
SourceFiles readSources(const std::filesystem::path& shader);

}  // namespace parhelion::gpu
