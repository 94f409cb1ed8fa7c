#include "app/process_start.h"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

namespace parhelion::app {

std::chrono::steady_clock::time_point processStart() {
    using Clock = std::chrono::steady_clock;
    static const Clock::time_point first = Clock::now();
    // Field 22 counts from boot, as the clock does on Linux but for suspended time; fields count from behind the name,
    // which may hold spaces and brackets.
    std::ifstream stat("/proc/self/stat");
    const std::string text((std::istreambuf_iterator<char>(stat)), {});
    const std::size_t name = text.rfind(')');
    std::ifstream uptimeFile("/proc/uptime");
    double uptime = 0;
    if (name == std::string::npos || !(uptimeFile >> uptime)) return first;
    std::istringstream fields(text.substr(name + 1));
    std::string skipped;
    for (int field = 3; field < 22; ++field) fields >> skipped;
    double ticks = 0;
    if (!(fields >> ticks)) return first;
    const double age = uptime - ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    if (!(age >= 0) || age > 1e6) return first;
    return Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(age));
}

}  // namespace parhelion::app
