// fork(); the child's last word comes through a pipe: the exit code that it means to end with, or, written by handlers
// of fatal signals and of atexit() in the thread that ends it, the call into a library that this thread was in. A child
// that ends without a word was ended by a library too. Linux alone ends the child where this process is killed.
#include "supervised.h"

#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "progress.h"
#include "signals.h"

#if defined(__unix__) || defined(__APPLE__)
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace crescent::cli {

namespace {

/// What goes through the pipe; less than PIPE_BUF, so that it arrives whole.
struct LastWord {
    enum Kind : int { none, meant, by_signal, by_exit } kind = none;
    int code = 0;
    char library[1024] = "", what[64] = "";  // of the call that the thread was in; "": in none
    Vec3d wo{};
};

int to_parent = -1;            // in the child
volatile pid_t child_id = -1;  // in the parent
std::atomic<bool> word_given{false};

// From here to take_over(): async-signal-safe calls alone (POSIX.1-2017, 2.4.3).

template <std::size_t n> void copy(const char* from, char (&to)[n]) {
    for (std::size_t i = 0; i + 1 < n && from && from[i]; ++i) to[i] = from[i];
}

void give_word(LastWord::Kind kind, int code) {
    if (to_parent < 0 || word_given.exchange(true)) return;
    LastWord word;
    word.kind = kind;
    word.code = code;
    const PluginCall call = plugin_call();
    copy(call.library, word.library);
    copy(call.what, word.what);
    word.wo = call.wo;
    static_cast<void>(!::write(to_parent, &word, sizeof word));
}

extern "C" void ends_by_signal(int signal) {
    give_word(LastWord::by_signal, signal);
    ::raise(signal);  // the handler is gone: SA_RESETHAND
}

/// Other threads are at work: what is left of exit() would take from them what they use.
extern "C" void ends_by_exit() {
    if (word_given) return;
    give_word(LastWord::by_exit, 0);
    std::fflush(nullptr);  // what the library said
    ::_exit(unwritable);
}

extern "C" void pass_on(int signal, siginfo_t* from, void*) {
#ifdef SI_KERNEL
    if (from->si_code == SI_KERNEL) return;  // a terminal's, which the child has got too
#endif
    const int before = errno;
    if (child_id > 0) ::kill(child_id, signal);
    errno = before;
}

/// The child from here on.
void take_over(int pipe, [[maybe_unused]] pid_t parent) {
    to_parent = pipe;
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(interrupted);
#endif
    struct sigaction action{};
    action.sa_handler = ends_by_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER;
    sigemptyset(&action.sa_mask);
    for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS})
        ::sigaction(fatal, &action, nullptr);
    std::atexit(ends_by_exit);
}

void pass_signals_on() {
    struct sigaction action{}, before{};
    action.sa_sigaction = pass_on;
    action.sa_flags = SA_RESTART | SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
            ::sigaction(signal, &action, nullptr);
}

sigset_t asking_signals() {
    sigset_t all;
    sigemptyset(&all);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&all, signal);
    return all;
}

/// The wait status of the child, once it has ended.
int wait_for(pid_t child) {
    siginfo_t about{};
    while (::waitid(P_PID, static_cast<id_t>(child), &about, WEXITED | WNOWAIT) != 0 && errno == EINTR) {}
    end_on_signals();  // before its id may be another's
    child_id = -1;
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    return status;
}

std::string names(const std::vector<CalledLibrary>& libraries) {
    std::vector<std::string> paths;
    for (const CalledLibrary& library : libraries)
        if (std::find(paths.begin(), paths.end(), library.path) == paths.end()) paths.push_back(library.path);
    return fmt::format(
        "the plugin{} {}", paths.size() > 1 ? "s" : "", printable(fmt::format("{}", fmt::join(paths, ", "))));
}

/// "the arm 'mine' broke off: " where one arm alone is meant.
std::string arm_words(const std::vector<CalledLibrary>& libraries, const std::string& path) {
    std::vector<std::string> arms;
    for (const CalledLibrary& library : libraries)
        if (!library.arm.empty() && (path.empty() || library.path == path)) arms.push_back(library.arm);
    return arms.size() == 1 ? fmt::format("the arm '{}' broke off: ", printable(arms[0])) : "";
}

std::string signal_words(int signal) {
    const char* name = ::strsignal(signal);
    return fmt::format("signal {}{}", signal, name ? fmt::format(" ({})", name) : "");
}

std::string fault_of(const std::vector<CalledLibrary>& libraries, const LastWord& word, int status) {
    const std::string how = WIFSIGNALED(status) ? signal_words(WTERMSIG(status))
        : word.kind == LastWord::by_exit        ? "a call of exit()"
                                                : fmt::format("exit code {}, without a word", WEXITSTATUS(status));
    const std::string arms = arm_words(libraries, word.library);
    if (word.library[0] == 0)
        return fmt::format("{}the process that called {} was ended by {}", arms, names(libraries), how);
    return fmt::format(
        "{}the plugin {} ended its process by {}", arms, to_string(PluginCall{word.library, word.what, word.wo}), how);
}

ChildEnd told(const std::vector<CalledLibrary>& libraries, pid_t child, int from_child, bool quiet) {
    const int status = wait_for(child);
    const sigset_t asking = asking_signals();
    LastWord word;
    const ssize_t n = ::read(from_child, &word, sizeof word);
    if (n != static_cast<ssize_t>(sizeof word)) word = {};
    ::close(from_child);
    if (WIFEXITED(status) && word.kind == LastWord::meant) return {word.code, ""};
    if (WIFSIGNALED(status) && sigismember(&asking, WTERMSIG(status)) == 1) return {interrupted, ""};
    if (!quiet && Progress::fitting() == Progress::Style::bar) std::fputs("\r\x1b[K", stderr);  // its bar
    return {unwritable, fault_of(libraries, word, status)};
}

}  // namespace

std::optional<ChildEnd> done_by_child(const std::vector<CalledLibrary>& libraries, bool quiet) {
    int ends[2];
    if (!make_pipe(ends)) return {};
    std::fflush(nullptr);
    const pid_t parent = ::getpid();
    const sigset_t asking = asking_signals();
    sigset_t before;
    ::sigprocmask(SIG_BLOCK, &asking, &before);
    const pid_t child = ::fork();
    if (child == 0) take_over(ends[1], parent);
    if (child > 0) {
        child_id = child;
        pass_signals_on();
    }
    ::sigprocmask(SIG_SETMASK, &before, nullptr);
    if (child != 0) ::close(ends[1]);
    if (child <= 0) ::close(ends[0]);
    if (child <= 0) return {};
    return told(libraries, child, ends[0], quiet);
}

int ends_on_purpose(int code) {
    give_word(LastWord::meant, code);
    return code;
}

}  // namespace crescent::cli
#else
namespace crescent::cli {

std::optional<ChildEnd> done_by_child(const std::vector<CalledLibrary>&, bool) { return {}; }
int ends_on_purpose(int code) { return code; }

}  // namespace crescent::cli
#endif

namespace crescent::cli {

namespace {

/// What a process that is dead was writing there goes; outputs that had begun to move are brought to their places.
void clear_after_it(const std::string& out) {
    try {
        Staging{out};
    } catch (const OutputError&) {}  // another run is at work there, and settles it
}

}  // namespace

std::optional<int> done_by_child(const Experiment& experiment, const std::string& out, bool quiet) {
    std::vector<CalledLibrary> libraries;
    for (const ArmPlan& arm : experiment.arms)
        if (arm.plugin) libraries.push_back({*arm.plugin, arm.name});
    if (libraries.empty()) return {};
    const std::optional<ChildEnd> end = done_by_child(libraries, quiet);
    if (!end) return {};
    if (end->fault.empty()) return end->code;
    clear_after_it(out);
    throw OutputError(end->fault);
}

}  // namespace crescent::cli
