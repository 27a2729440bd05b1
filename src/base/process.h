// Other programs: started, fed, read and ended. One class for samplers behind pipes, hosts of plugins and ffmpeg.
// Linux has all that is promised here; elsewhere a program that ignores the end of its input may outlive a process
// that was killed.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "base/progress.h"

namespace crescent::inline base {

/// What is started, and where its streams go.
struct ProcessPlan {
    std::vector<std::string> argv;
    std::string file{};         // that is executed; "": argv[0], looked for in PATH
    std::string stdin_file{};   // "": a pipe
    std::string stdout_file{};  // to be written; "": a pipe
    std::string stderr_file{};  // to be written; "": our own stderr, line by line behind `label`
    std::string label = argv.empty() ? "" : argv[0];
    int shared = -1;  // a descriptor of ours that it gets as its descriptor 3
};

/// How a program ended.
struct ProcessEnd {
    int code = 0, signal = 0;  // signal 0: by itself, with the code
    /// "exit code 3", "signal 11 (SIGSEGV)".
    std::string text() const;
    bool well() const { return code == 0 && signal == 0; }
};

/// A program in a process group of its own, which inherits no descriptor but those of its plan, no signal mask and no
/// ignored signal. The group is killed when this object is destroyed, and on Linux the program also when this process
/// dies. Used by one thread at a time.
class Process {
public:
    /// Throws OutputError if the program or a file cannot be opened.
    explicit Process(const ProcessPlan& plan);
    ~Process() { end(0); }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Waits until it reads or has written, or for so long. What it wrote to stderr in the meantime is passed on.
    struct Ready {
        bool input = false, output = false;  // write() and read() do not return 0
    };
    Ready wait_ready(bool to_write, bool to_read, int milliseconds);

    /// Both as write(2) and read(2) without blocking: -1 and errno, EAGAIN among them; read() returns 0 at the end.
    /// A program that closed its input shows as EPIPE, and no signal of this process is touched.
    ssize_t write(std::string_view bytes) const;
    ssize_t read(char* to, std::size_t most) const;
    /// How it ended; waits for it for so long. Nothing while it runs.
    std::optional<ProcessEnd> ended(int milliseconds);
    /// Closes its input and waits for its end. Throws Interrupted if the monitor says so.
    ProcessEnd wait(const ProgressMonitor& monitor);
    /// Closes both pipes, gives it so long to end by itself, and kills what is left of its group.
    void end(int milliseconds);

    /// What a program leaves behind becomes a child of this process, if it is in a session of its own too. For
    /// programs, whose children are all made here; Linux alone can.
    static void adopt_orphans() noexcept;
    /// Kills all groups and adopted orphans, and waits for them for up to half a second. Async-signal-safe: the last
    /// that a program does, also in a handler.
    static void kill_all() noexcept;

private:
    void pass_on_stderr();
    void print_line(std::string_view line) const;
    void finish_line();

    std::string label_, line_;  // line_: the last line of stderr, which has no end yet
    pid_t pid_ = -1, owner_ = -1;
    int in_ = -1, out_ = -1, err_ = -1;
    std::size_t slot_ = 0;
    std::optional<ProcessEnd> ended_;
};

}  // namespace crescent::inline base
