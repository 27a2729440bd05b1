// Other programs: one command at a time, its streams in files or a pipe.
#pragma once

#include <string>
#include <vector>

#include "crescent.h"

namespace crescent::film {

/// A program that was started; ended when this goes, unless it has been waited for.
class Process {
public:
    /// `stdin_file` "": a pipe that write() feeds. OutputError where the program cannot be started.
    Process(const std::vector<std::string>& argv, const std::string& stdin_file, const std::string& stdout_file,
        const std::string& stderr_file);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// False: the program does not read any more.
    bool write(const unsigned char* bytes, std::size_t size);
    /// Closes the pipe and waits; the exit code, 128 + signal where a signal ended it. Interrupted where the monitor
    /// says so.
    int wait(const ProgressMonitor& monitor);

private:
    int pid_ = -1, pipe_ = -1;
};

}  // namespace crescent::film
