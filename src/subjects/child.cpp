// Two processes a program: a guard, and under it the shell. The guard ends when the pipe `life` closes, however this
// process dies, and takes everything that the shell has started with it. POSIX, with Linux's ways to find orphans.
#include "subjects/child.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/select.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "base/pipe.h"
#include "subjects/faults.h"

namespace crescent::inline subjects {

namespace {

struct Ends {
    int read = -1, write = -1;
    Ends() {
        int fd[2];
        if (!make_pipe(fd)) throw SubjectFault(fmt::format("no pipe: {}", std::strerror(errno)));
        read = fd[0];
        write = fd[1];
    }
    ~Ends() {
        for (int fd : {read, write})
            if (fd >= 0) close(fd);
    }
    Ends(const Ends&) = delete;
    Ends& operator=(const Ends&) = delete;
};

int taken(int& fd) { return std::exchange(fd, -1); }

// From here to hold(): after fork() in a process of many threads, so async-signal-safe calls alone
// (POSIX.1-2017, 2.4.3).

extern "C" void wake(int) {}

/// Takes over the children that a child of this process leaves behind; Linux alone can.
void adopt_orphans() {
#ifdef __linux__
    prctl(PR_SET_CHILD_SUBREAPER, 1);
#endif
}

/// No descriptor from `first` on stays open.
void close_from(int first) {
#ifdef __linux__
    if (close_range(static_cast<unsigned>(first), ~0u, 0) == 0) return;
#endif
    const long most = sysconf(_SC_OPEN_MAX);
    for (int fd = first; fd < (most > 0 ? most : 1024); ++fd) close(fd);
}

/// Kills every child, which hands its own children over to this process, until none is left; two seconds at most. Where
/// the system does not list children, `group`, which the last of them leads: what moved to another group ends when its
/// pipes do.
void kill_all(pid_t group) {
    for (int round = 0; round < 200; ++round) {
        while (waitpid(-1, nullptr, WNOHANG) > 0) {}
        if (waitpid(-1, nullptr, WNOHANG) < 0) return;  // ECHILD
        const int list = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
        char text[4096];
        const ssize_t n = list < 0 ? 0 : read(list, text, sizeof text);
        if (list >= 0) close(list);
        else kill(-group, SIGKILL);
        pid_t pid = 0;
        for (ssize_t i = 0; i < n; ++i) {
            if (text[i] >= '0' && text[i] <= '9') pid = 10 * pid + (text[i] - '0');
            else if (pid > 0) kill(std::exchange(pid, 0), SIGKILL);
        }
        const timespec moment{0, 10'000'000};
        nanosleep(&moment, nullptr);
    }
}

/// The guard: tells how the shell ended, and ends everything when the other end of `life` is closed.
[[noreturn]] void stand_guard(int life, int told, int in, int out, const char* command) {
    for (int* fd : {&life, &told, &in, &out}) *fd = fcntl(*fd, F_DUPFD_CLOEXEC, 3);  // clear of 0 and 1
    setpgid(0, 0);
    adopt_orphans();
    sigset_t child_ended, before;
    sigemptyset(&child_ended);
    sigaddset(&child_ended, SIGCHLD);
    sigprocmask(SIG_BLOCK, &child_ended, &before);
    struct sigaction action{};
    action.sa_handler = wake;
    sigaction(SIGCHLD, &action, nullptr);
    for (int s : {SIGINT, SIGTERM, SIGHUP}) signal(s, SIG_IGN);
    const pid_t shell = fork();
    if (shell == 0) {
        setpgid(0, 0);
        dup2(in, 0);
        dup2(out, 1);
        for (int s : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) signal(s, SIG_DFL);
        sigprocmask(SIG_SETMASK, &before, nullptr);
        execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
        _exit(127);
    }
    if (shell < 0) _exit(126);
    dup2(life, 0);
    dup2(told, 1);
    close_from(3);
    for (bool lives = true;;) {
        int status = 0;
        for (pid_t ended; (ended = waitpid(-1, &status, WNOHANG)) > 0;)
            if (ended == shell && lives) {
                lives = false;
                static_cast<void>(!write(1, &status, sizeof status));
            }
        fd_set life_end;
        FD_ZERO(&life_end);
        FD_SET(0, &life_end);
        if (pselect(1, &life_end, nullptr, nullptr, nullptr, &before) > 0) break;
    }
    kill_all(shell);
    _exit(0);
}

}  // namespace

Child::Child(const std::string& command) {
    Ends in, out, life, told;
    guard_ = fork();
    if (guard_ == 0) {
        close(life.write);
        stand_guard(life.read, told.write, in.read, out.write, command.c_str());
    }
    if (guard_ < 0) throw SubjectFault(fmt::format("no process: {}", std::strerror(errno)));
    to_ = taken(in.write);
    from_ = taken(out.read);
    life_ = taken(life.write);
    told_ = taken(told.read);
    for (int fd : {to_, from_}) fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
}

Child::~Child() { end(0); }

ssize_t Child::write(std::string_view text) const {
    sigset_t pipe, before, earlier, pending;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    sigpending(&earlier);
    pthread_sigmask(SIG_BLOCK, &pipe, &before);
    const ssize_t n = ::write(to_, text.data(), text.size());
    const int why = errno;
    sigpending(&pending);
    int ours = 0;
    if (n < 0 && !sigismember(&earlier, SIGPIPE) && sigismember(&pending, SIGPIPE)) sigwait(&pipe, &ours);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    errno = why;
    return n;
}

std::optional<int> Child::status(int milliseconds) const {
    if (status_ || told_ < 0) return status_;
    pollfd end{told_, POLLIN, 0};
    int status = 0;
    if (poll(&end, 1, milliseconds) > 0 && read(told_, &status, sizeof status) == sizeof status) status_ = status;
    return status_;
}

void Child::end(int milliseconds) {
    if (guard_ < 0) return;
    for (int* fd : {&to_, &from_}) close(taken(*fd));
    if (milliseconds > 0) status(milliseconds);
    for (int* fd : {&life_, &told_}) close(taken(*fd));
    while (waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) {}
    guard_ = -1;
}

}  // namespace crescent::inline subjects
