#pragma once

namespace parhelion::app {

/// What the process tells its caller.
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitFailed = 1;         ///< a comparison missed a threshold, or a render counted anomalies
inline constexpr int kExitInput = 2;          ///< bad input or usage
inline constexpr int kExitRuntime = 3;        ///< out of memory, a failing device, a full disk
inline constexpr int kExitInterrupted = 130;  ///< SIGINT or SIGTERM; a render has written what it had

}  // namespace parhelion::app
