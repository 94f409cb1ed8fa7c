#include "support/process_memory.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace parhelion::test {

ProcessMemory memoryOf(pid_t process) {
    std::ifstream maps(fmt::format("/proc/{}/smaps", process));
    ProcessMemory memory;
    bool compiled = false, found = false;
    for (std::string line; std::getline(maps, line);) {
        std::istringstream words(line);
        std::string first, access, offset, device, file, path;
        words >> first >> access;
        if (!first.ends_with(':')) {  // address range: a mapping begins; "[heap]" and the like are no files
            words >> offset >> device >> file >> path;
            compiled = access.find('x') != std::string::npos && (path.empty() || path.starts_with("[anon"));
        } else if (first == "Rss:") {
            memory.residentKiB += std::stol(access);
        } else if (first == "Size:" && compiled) {
            memory.executableKiB += std::stol(access);
        }
        found = true;
    }
    if (!found) throw std::runtime_error(fmt::format("process {} has no memory to look at", process));
    return memory;
}

}  // namespace parhelion::test
