// A program started by the shell, with its stdin and stdout at hand. A guard process stands between: it ends the
// program and everything that the program started, sessions of their own included, as soon as this object or this
// process is gone, by whatever signal.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <sys/types.h>

namespace crescent::inline subjects {

class Child {
public:
    /// Starts `command` with /bin/sh -c. Throws SubjectFault where there is no process to be had.
    explicit Child(const std::string& command);
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Both without blocking.
    int input() const { return to_; }
    int output() const { return from_; }
    /// As write(2) into its input; a program that closed it shows as EPIPE, and no signal of this process is touched.
    ssize_t write(std::string_view text) const;
    /// The shell's wait status, once it has ended; waits for it up to so long.
    std::optional<int> status(int milliseconds) const;
    /// Closes both ends, gives it so long to end by itself, and ends what is left.
    void end(int milliseconds);

private:
    pid_t guard_ = -1;
    int to_ = -1, from_ = -1, life_ = -1, told_ = -1;
    mutable std::optional<int> status_;
};

}  // namespace crescent::inline subjects
