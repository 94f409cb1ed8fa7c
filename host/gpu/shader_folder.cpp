#include <fmt/format.h>

#include <cstdlib>

#include "base/error.h"
#include "gpu/pipeline.h"

namespace parhelion::gpu {
namespace fs = std::filesystem;

fs::path shaderFolder() {
    if (const char* chosen = std::getenv("PARHELION_SHADERS")) {
        if (!fs::is_directory(chosen))
            throw InputError(fmt::format("PARHELION_SHADERS must name the folder of the shaders; got \"{}\"", chosen));
        return fs::path(chosen).lexically_normal();
    }
    if (fs::is_directory(PARHELION_SOURCE_SHADERS)) return PARHELION_SOURCE_SHADERS;
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    const fs::path installed = program.parent_path().parent_path() / "share" / "parhelion" / "shaders";
    if (fs::is_directory(installed)) return installed;
    throw RuntimeFailure(fmt::format("the shaders are neither in {} nor in {}; set PARHELION_SHADERS to their folder",
                                     PARHELION_SOURCE_SHADERS, installed.string()));
}

}  // namespace parhelion::gpu
