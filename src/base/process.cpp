// fork() and exec(). Between them the child makes only async-signal-safe calls (POSIX.1-2017, 2.4.3), and reports over
// a pipe why exec failed. The leader of a group is reaped after the group was killed, so that its number cannot belong
// to another group by then.
#include "base/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

#ifdef __linux__
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

#include "base/errors.h"
#include "base/text.h"

namespace crescent {

namespace {

/// Output of a program without line ends is passed on in pieces of this many bytes.
constexpr std::size_t longest_line = 4096;

/// The live process groups, for kill_all(): 0 is a free entry. A process beyond these is killed only by its object.
std::array<std::atomic<pid_t>, 4096> live_groups{};

std::size_t registered(pid_t group) {
    for (std::size_t k = 0; k < live_groups.size(); ++k) {
        pid_t free = 0;
        if (live_groups[k].load(std::memory_order_relaxed) == 0 && live_groups[k].compare_exchange_strong(free, group))
            return k;
    }
    return live_groups.size();
}

void close_one(int& fd) {
    if (fd >= 0) ::close(std::exchange(fd, -1));
}

/// The two ends of a pipe, or a file at one of them.
struct Stream {
    int ours = -1, theirs = -1;
    Stream() = default;
    ~Stream() {
        close_one(ours);
        close_one(theirs);
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    void open(const std::string& file, bool they_read) {
        if (file.empty()) return make_pipe(they_read);
        theirs = ::open(file.c_str(), (they_read ? O_RDONLY : O_WRONLY | O_CREAT | O_TRUNC) | O_CLOEXEC, 0666);
        if (theirs < 0) throw OutputError(fmt::format("cannot open {}: {}", file, std::strerror(errno)));
    }
    /// No other program inherits an end; on systems other than Linux a program started by another thread at that moment
    /// may.
    void make_pipe(bool they_read) {
        int ends[2];
#ifdef __linux__
        const bool has_pipe = ::pipe2(ends, O_CLOEXEC) == 0;
        if (has_pipe) ::fcntl(ends[0], F_SETPIPE_SZ, 1 << 20);  // blocks of rows in fewer turns; may be refused
#else
        const bool has_pipe = ::pipe(ends) == 0;
        for (const int end : ends)
            if (has_pipe) ::fcntl(end, F_SETFD, FD_CLOEXEC);
#endif
        if (!has_pipe) throw OutputError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
        theirs = ends[they_read ? 0 : 1];
        ours = ends[they_read ? 1 : 0];
    }
};

/// Every signal is blocked while it lives: a handler of this process cannot run in the child.
class AllBlocked {
public:
    AllBlocked() {
        sigset_t signals;
        sigfillset(&signals);
        pthread_sigmask(SIG_SETMASK, &signals, &old_mask_);
    }
    ~AllBlocked() { pthread_sigmask(SIG_SETMASK, &old_mask_, nullptr); }
    AllBlocked(const AllBlocked&) = delete;
    AllBlocked& operator=(const AllBlocked&) = delete;

private:
    sigset_t old_mask_;
};

std::atomic<bool> adopting{false};

/// Kills the children of the main thread, including adopted ones. Async-signal-safe.
void kill_children() {
    char path[64] = "/proc/self/task/", digits[24], text[4096];
    std::size_t length = std::strlen(path), count = 0;
    for (pid_t id = ::getpid(); id > 0; id /= 10) digits[count++] = static_cast<char>('0' + id % 10);
    while (count > 0) path[length++] = digits[--count];
    std::memcpy(path + length, "/children", sizeof "/children");
    const int list = ::open(path, O_RDONLY | O_CLOEXEC);
    if (list < 0) return;
    const ssize_t n = ::read(list, text, sizeof text);
    ::close(list);
    pid_t child = 0;
    for (ssize_t i = 0; i < n; ++i) {
        if (text[i] >= '0' && text[i] <= '9') child = 10 * child + (text[i] - '0');
        else if (child > 0) ::kill(std::exchange(child, 0), SIGKILL);
    }
}

bool in_main_thread() {
#ifdef __linux__
    return ::syscall(SYS_gettid) == ::getpid();
#else
    return false;
#endif
}

// Called between fork and exec.

void close_at_exec_from(int first) {
#if defined(__linux__) && defined(SYS_close_range)
    constexpr unsigned only_mark = 4;  // CLOSE_RANGE_CLOEXEC of Linux 5.11
    if (::syscall(SYS_close_range, static_cast<unsigned>(first), ~0u, only_mark) == 0) return;
#endif
    const long limit = ::sysconf(_SC_OPEN_MAX);
    for (int fd = first; fd < (limit > 0 ? limit : 1024); ++fd) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

void reset_signals() {
    struct sigaction action{};
    action.sa_handler = SIG_DFL;
    for (int s = 1; s < NSIG; ++s) ::sigaction(s, &action, nullptr);  // KILL and STOP refuse
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

struct Start {
    const char* file;
    char* const* argv;
    int in, out, err, shared, failure;
    pid_t parent;
    bool dies_with_thread;
};

[[noreturn]] void exec_program(Start start) {
    ::setpgid(0, 0);  // Ctrl-C of the terminal is passed on by this process
#ifdef __linux__
    // The signal is sent when the thread that forked ends: only the main thread lives as long as the process.
    if (start.dies_with_thread) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() != start.parent) ::_exit(127);
    }
#endif
    for (int* fd : {&start.in, &start.out, &start.err, &start.shared, &start.failure})
        if (*fd >= 0 && *fd < 4) *fd = ::fcntl(*fd, F_DUPFD_CLOEXEC, 4);
    close_at_exec_from(3);
    ::dup2(start.in, 0);
    ::dup2(start.out, 1);
    ::dup2(start.err, 2);
    if (start.shared >= 0) ::dup2(start.shared, 3);
    reset_signals();
    ::execvp(start.file, start.argv);
    const int why = errno;
    static_cast<void>(!::write(start.failure, &why, sizeof why));
    ::_exit(127);
}

void make_nonblocking(int fd) {
    if (fd >= 0) ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
}

/// Returns how much of a line is passed on at once: whole characters of UTF-8.
std::size_t piece_of(std::string_view line) {
    std::size_t size = std::min(line.size(), longest_line);
    for (int k = 0; k < 3 && size < line.size() && (static_cast<unsigned char>(line[size]) & 0xC0) == 0x80; ++k) --size;
    return size;
}

/// One line on stderr. On a terminal the line that a progress bar may be drawn on is cleared first.
void print_piece(const std::string& label, std::string piece) {
    std::replace(piece.begin(), piece.end(), '\t', ' ');
    const char* term = std::getenv("TERM");
    const bool clear = ::isatty(STDERR_FILENO) && term && std::string_view(term) != "dumb";
    const std::string text = fmt::format("{}{}: {}\n", clear ? "\r\x1b[K" : "", label, printable(piece));
    for (std::size_t offset = 0; offset < text.size();) {
        const ssize_t n = ::write(STDERR_FILENO, text.data() + offset, text.size() - offset);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;  // reporting is no longer possible
        offset += static_cast<std::size_t>(n);
    }
}

}  // namespace

std::string ProcessEnd::text() const {
    if (signal == 0) return fmt::format("exit code {}", code);
#ifdef __GLIBC__
    if (const char* name = ::sigabbrev_np(signal)) return fmt::format("signal {} (SIG{})", signal, name);
#endif
    return fmt::format("signal {} ({})", signal, ::strsignal(signal));
}

Process::Process(const ProcessPlan& plan) : label_(printable(plan.label, 60)), owner_(::getpid()) {
    std::vector<char*> argv;
    for (const std::string& word : plan.argv) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    Stream in, out, err, failure;
    in.open(plan.stdin_file, true);
    out.open(plan.stdout_file, false);
    err.open(plan.stderr_file, false);
    failure.make_pipe(false);
    const char* file = plan.file.empty() ? argv[0] : plan.file.c_str();
    const Start start{.file = file,
        .argv = argv.data(),
        .in = in.theirs,
        .out = out.theirs,
        .err = err.theirs,
        .shared = plan.shared,
        .failure = failure.theirs,
        .parent = owner_,
        .dies_with_thread = in_main_thread()};
    int why = 0;
    {
        const AllBlocked blocked;
        pid_ = ::fork();
        if (pid_ == 0) exec_program(start);
        why = pid_ < 0 ? errno : 0;
        if (pid_ > 0) {
            ::setpgid(pid_, pid_);  // whichever of the two processes is first
            slot_ = registered(pid_);
        }
    }
    close_one(failure.theirs);
    if (pid_ > 0 && ::read(failure.ours, &why, sizeof why) != static_cast<ssize_t>(sizeof why)) why = 0;
    if (why != 0) {
        end(0);
        throw OutputError(fmt::format("cannot start {}: {}", printable(file), std::strerror(why)));
    }
    in_ = std::exchange(in.ours, -1);
    out_ = std::exchange(out.ours, -1);
    err_ = std::exchange(err.ours, -1);
    for (const int fd : {in_, out_, err_}) make_nonblocking(fd);
}

Process::Ready Process::wait_ready(bool to_write, bool to_read, int milliseconds) {
    pollfd ends[3] = {{to_write ? in_ : -1, POLLOUT, 0}, {to_read ? out_ : -1, POLLIN, 0}, {err_, POLLIN, 0}};
    if (::poll(ends, 3, milliseconds) <= 0) return {};
    if (ends[2].revents != 0) pass_on_stderr();
    return {ends[0].revents != 0, ends[1].revents != 0};
}

ssize_t Process::write(std::string_view bytes) const {
    sigset_t pipe, old_mask, earlier, pending;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    sigpending(&earlier);
    pthread_sigmask(SIG_BLOCK, &pipe, &old_mask);
    const ssize_t n = ::write(in_, bytes.data(), bytes.size());
    const int why = errno;
    sigpending(&pending);
    int ours = 0;
    if (n < 0 && !sigismember(&earlier, SIGPIPE) && sigismember(&pending, SIGPIPE)) sigwait(&pipe, &ours);
    pthread_sigmask(SIG_SETMASK, &old_mask, nullptr);
    errno = why;
    return n;
}

ssize_t Process::read(char* to, std::size_t limit) const { return ::read(out_, to, limit); }

std::optional<ProcessEnd> Process::ended(int milliseconds) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    while (!ended_ && pid_ > 0) {
        siginfo_t info{};
        const int result = ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
        if (result != 0 && errno != EINTR) ended_ = ProcessEnd{};  // reaped elsewhere: the exit status is unknown
        if (result == 0 && info.si_pid == pid_)
            ended_ = info.si_code == CLD_EXITED ? ProcessEnd{info.si_status, 0} : ProcessEnd{0, info.si_status};
        if (ended_ || std::chrono::steady_clock::now() >= deadline) break;
        wait_ready(false, false, 1);
    }
    if (ended_) pass_on_stderr();
    return ended_;
}

ProcessEnd Process::wait(const ProgressMonitor& monitor) {
    close_one(in_);
    for (;;) {
        monitor.check();
        if (const std::optional<ProcessEnd> end = ended(50)) return *end;
    }
}

void Process::end(int milliseconds) {
    close_one(in_);
    close_one(out_);
    if (pid_ > 0 && ::getpid() == owner_) {
        if (milliseconds > 0) ended(milliseconds);
        for (const pid_t which : {-pid_, pid_}) ::kill(which, SIGKILL);
        if (slot_ < live_groups.size()) live_groups[slot_] = 0;
        while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {}
        pass_on_stderr();
        finish_line();
    }
    close_one(err_);
    pid_ = -1;
}

void Process::kill_all() noexcept {
    for (const std::atomic<pid_t>& place : live_groups)
        if (const pid_t group = place.load(std::memory_order_relaxed); group > 0)
            for (const pid_t which : {-group, group}) ::kill(which, SIGKILL);
    if (!adopting.load(std::memory_order_relaxed)) return;
    for (int round = 0; round < 50; ++round) {
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {}
        if (::waitpid(-1, nullptr, WNOHANG) < 0) return;  // ECHILD: none is left
        kill_children();
        const timespec moment{0, 10'000'000};
        ::nanosleep(&moment, nullptr);
    }
}

void Process::adopt_orphans() noexcept {
#ifdef __linux__
    adopting = ::prctl(PR_SET_CHILD_SUBREAPER, 1) == 0;
#endif
}

/// Reads what is available, at most the contents of a pipe.
void Process::pass_on_stderr() {
    char buffer[1 << 14];
    for (int round = 0; round < 4 && err_ >= 0; ++round) {
        const ssize_t n = ::read(err_, buffer, sizeof buffer);
        if (n == 0) close_one(err_);
        if (n <= 0) break;
        line_.append(buffer, static_cast<std::size_t>(n));
        std::size_t first = 0;
        for (std::size_t end; (end = line_.find('\n', first)) != std::string::npos; first = end + 1)
            print_line(std::string_view(line_).substr(first, end - first));
        line_.erase(0, first);
        while (line_.size() > longest_line) {
            const std::size_t size = piece_of(line_);
            print_piece(label_, line_.substr(0, size));
            line_.erase(0, size);
        }
    }
    if (err_ < 0) finish_line();
}

void Process::print_line(std::string_view line) const {
    if (line.ends_with('\r')) line.remove_suffix(1);
    do {
        const std::size_t size = piece_of(line);
        print_piece(label_, std::string(line.substr(0, size)));
        line.remove_prefix(size);
    } while (!line.empty());
}

void Process::finish_line() {
    if (!line_.empty()) print_line(std::exchange(line_, ""));
}

}  // namespace crescent
