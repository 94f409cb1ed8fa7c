#include "base/memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace parhelion {

std::size_t physicalMemoryBytes() {
    std::size_t limit =
        static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    // Inside a container the machine's own figure is out of reach (cgroup v2, v1). "max" does not parse as a number.
    for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::size_t group = 0;
        if (std::ifstream(file) >> group && group > 0) limit = std::min(limit, group);
    }
    return limit;
}

}  // namespace parhelion
