#pragma once

#include <sys/types.h>

namespace parhelion::test {

/// Memory of a process, from /proc/PID/smaps.
struct ProcessMemory {
    long residentKiB = 0;
    long executableKiB = 0;  ///< mapped executable and no file's: what compilers have made while it ran
};

/// @throws std::runtime_error where the process is gone.
ProcessMemory memoryOf(pid_t process);

}  // namespace parhelion::test
