// Starts, feeds, reads and ends other programs: samplers behind pipes, hosts of plugins and ffmpeg. All guarantees hold
// on Linux; on other systems a program that ignores the end of its input may outlive a process that was killed.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "base/progress.h"

namespace crescent {

/// What to start, and its streams.
struct ProcessPlan {
    std::vector<std::string> argv;
    std::string file{};         // file to execute; "": argv[0], searched in PATH
    std::string stdin_file{};   // "": a pipe
    std::string stdout_file{};  // written; "": a pipe
    std::string stderr_file{};  // written; "": our own stderr, line by line after `label`
    std::string label = argv.empty() ? "" : argv[0];
    int shared = -1;  // a descriptor of ours that it receives as its descriptor 3
};

/// How a program ended.
struct ProcessEnd {
    int code = 0, signal = 0;  // signal 0: exited with this code
    /// "exit code 3", "signal 11 (SIGSEGV)".
    std::string text() const;
    bool well() const { return code == 0 && signal == 0; }
};

/// A program in a process group of its own, which inherits only the descriptors of its plan, no signal mask and no
/// ignored signal. The group is killed when this object is destroyed, and on Linux the program also when this process
/// dies. Used by one thread at a time.
class Process {
public:
    /// Throws OutputError if the program or a file cannot be opened.
    explicit Process(const ProcessPlan& plan);
    ~Process() { end(0); }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Waits until it reads or has written, or until the time is over. Passes on what it wrote to stderr meanwhile.
    struct Ready {
        bool input = false, output = false;  // write() and read() do not return 0
    };
    Ready wait_ready(bool to_write, bool to_read, int milliseconds);

    /// Both like write(2) and read(2) without blocking: -1 and errno, including EAGAIN; read() returns 0 at the end. A
    /// program that closed its input gives EPIPE, and no signal of this process is changed.
    ssize_t write(std::string_view bytes) const;
    ssize_t read(char* to, std::size_t limit) const;
    /// Returns how it ended, waiting at most this long; empty while it runs.
    std::optional<ProcessEnd> ended(int milliseconds);
    /// Closes its input and waits for its end. Throws Interrupted if the monitor requests a stop.
    ProcessEnd wait(const ProgressMonitor& monitor);
    /// Closes both pipes, waits this long for it to end, and kills the rest of its group.
    void end(int milliseconds);

    /// Makes orphans of a program children of this process, also if they are in a session of their own. For programs
    /// whose children are all started here; only on Linux.
    static void adopt_orphans() noexcept;
    /// Kills all groups and adopted orphans, and waits for them for up to half a second. Async-signal-safe: the last
    /// call of a program, also in a handler.
    static void kill_all() noexcept;

private:
    void pass_on_stderr();
    void print_line(std::string_view line) const;
    void finish_line();

    std::string label_, line_;  // line_: the last line of stderr, not terminated yet
    pid_t pid_ = -1, owner_ = -1;
    int in_ = -1, out_ = -1, err_ = -1;
    std::size_t slot_ = 0;
    std::optional<ProcessEnd> ended_;
};

}  // namespace crescent
