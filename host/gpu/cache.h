#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace parhelion::gpu {

/// A folder for what can be rebuilt at any time, created when missing: `part` below $XDG_CACHE_HOME/parhelion,
/// ~/.cache/parhelion, or a folder of this user in the system's temporary folder, whichever can be written first.
/// Empty when none can: callers then go without a cache.
std::filesystem::path cacheFolder(std::string_view part);

/// What a user should know of where compiled shaders are kept: empty unless neither $XDG_CACHE_HOME nor ~/.cache can be
/// written, which makes starts slow where the temporary folder is emptied, or always where that cannot be written
/// either.
std::string cacheNote();

/// 64-bit FNV-1a of the bytes, continuing from `hash`.
std::uint64_t contentHash(std::span<const std::byte> bytes, std::uint64_t hash = 0xcbf29ce484222325ull);
std::uint64_t contentHash(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325ull);

/// What writeCacheFile stored; empty when the file is missing, cut short or damaged (its checksum disagrees).
std::vector<std::byte> readCacheFile(const std::filesystem::path& file);

/// Stores the bytes with their checksum, replacing the file in one step. Failing to is no error: it is only a cache.
void writeCacheFile(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace parhelion::gpu
