#pragma once

#include <cstddef>

namespace parhelion {

/// Memory this process may use at most, bytes: the machine's, or the control group's limit where that is lower.
std::size_t physicalMemoryBytes();

}  // namespace parhelion
