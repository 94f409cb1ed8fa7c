#pragma once

#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>

namespace parhelion::app {

/// SIGINT and SIGTERM for as long as this lives: at first they end the process at once; after deferFirst() the first
/// one only asks, and the second ends the process. The process then exits with kExitInterrupted, never inside
/// holdOff().
///
/// A thread of its own waits for the signals, so that nothing has to run in a signal handler. Construct it before
/// anything else starts threads: they inherit the blocked signals. A signal that the parent set to be ignored
/// (nohup, background jobs) stays ignored.
class Interruption {
public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// There is work to save from here on.
    void deferFirst() { deferred_ = true; }
    /// True once a deferred signal asked to stop.
    const std::atomic<bool>& requested() const { return requested_; }
    /// The process is not ended while the lock is held: for writing outputs.
    [[nodiscard]] std::unique_lock<std::mutex> holdOff() { return std::unique_lock(outputs_); }

private:
    void waitForSignals();

    sigset_t signals_;
    sigset_t previous_;
    std::atomic<bool> deferred_ = false;
    std::atomic<bool> requested_ = false;
    std::atomic<bool> closing_ = false;
    std::mutex outputs_;
    std::thread waiter_;  ///< last: it uses the others
};

}  // namespace parhelion::app
