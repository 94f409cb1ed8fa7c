#pragma once

#include <chrono>

namespace parhelion::app {

/// When this process began, before main: the system's own record, to 1/100 s.
std::chrono::steady_clock::time_point processStart();

}  // namespace parhelion::app
