#include "gpu/software_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "gpu/cache.h"

namespace parhelion::gpu {
namespace {

constexpr const char* kWidthVariable = "LP_NATIVE_VECTOR_WIDTH";

void useShaderCacheOfWidth(const std::string& width) {
    if (std::getenv("MESA_SHADER_CACHE_DIR") || std::getenv("MESA_SHADER_CACHE_DISABLE")) return;
    const auto folder = cacheFolder("mesa-" + width);
    if (folder.empty())
        ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    else
        ::setenv("MESA_SHADER_CACHE_DIR", folder.c_str(), 0);
}

}  // namespace

unsigned widestVectorBits() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return 512;
    if (__builtin_cpu_supports("avx2")) return 256;
#endif
    return 128;
}

void configureSoftwareDriver(unsigned vectorBits, unsigned preferredBits) {
    if (vectorBits != 0 && vectorBits != 128 && vectorBits != 256 && vectorBits != 512)
        throw InputError(fmt::format("vector width must be 128, 256 or 512 bits (0: the widest); got {}", vectorBits));
    const unsigned chosen = vectorBits != 0 ? vectorBits : std::min(preferredBits, widestVectorBits());
    ::setenv(kWidthVariable, std::to_string(chosen).c_str(), 0);
    const std::string width = std::getenv(kWidthVariable);
    if (vectorBits != 0 && width != std::to_string(vectorBits))
        throw InputError(
            fmt::format("vector width is already {} bits ({} of the environment, or an earlier device); "
                        "got {}",
                        width, kWidthVariable, vectorBits));
    useShaderCacheOfWidth(width);
}

}  // namespace parhelion::gpu
