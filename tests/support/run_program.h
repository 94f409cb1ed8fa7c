#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace parhelion::test {

/// How a program ended and what it said.
struct ProgramResult {
    int exitCode = 0;  ///< minus the signal's number when a signal ended it
    std::string output, error;
    long peakMemoryKiB = 0;
};

/// A program running as a child process, its output captured; killed by the destructor.
class ChildProgram {
public:
    /// @param folder  the child's current folder.
    ChildProgram(const std::string& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& folder);
    ~ChildProgram();
    ChildProgram(const ChildProgram&) = delete;
    ChildProgram& operator=(const ChildProgram&) = delete;

    /// Waits until the child has written `text` to its standard error. False after the limit, or when it ended first.
    bool waitForError(const std::string& text, std::chrono::seconds limit = std::chrono::seconds(60));
    void signal(int number) const;
    pid_t process() const { return process_; }  ///< -1 once it has ended
    /// Waits for the end; kills the child after the limit, which shows as exit code -SIGKILL.
    ProgramResult wait(std::chrono::seconds limit = std::chrono::seconds(120));

private:
    bool hasEnded();

    TemporaryFolder captured_;
    pid_t process_ = -1;
    ProgramResult result_;
};

/// Runs a program to its end.
ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments,
                         const std::filesystem::path& folder);

}  // namespace parhelion::test
