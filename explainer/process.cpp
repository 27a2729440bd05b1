// fork() and execvp(). Over a pipe the child tells why exec failed; it leads a process group of its own and, on Linux,
// is killed when its parent dies. wait() asks waitpid() and the monitor every 2 ms.
#include "process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace crescent::film {

namespace {

int opened(const std::string& path, int flags) {
    const int fd = ::open(path.empty() ? "/dev/null" : path.c_str(), flags | O_CLOEXEC, 0666);
    if (fd < 0) throw OutputError(fmt::format("cannot open {}: {}", path, std::strerror(errno)));
    return fd;
}

struct Descriptors {
    int in = -1, out = -1, err = -1;
    int feed = -1;  // the other end of `in`
    ~Descriptors() {
        for (const int fd : {in, out, err, feed})
            if (fd >= 0) ::close(fd);
    }
};

/// In the child: only what may be called between fork and exec.
[[noreturn]] void become(const std::vector<char*>& argv, const Descriptors& streams, int tell) {
    ::setpgid(0, 0);  // a Ctrl-C is for us to pass on
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // elsewhere it ends when its pipe does
#endif
    for (const int s : {SIGPIPE, SIGXFSZ}) ::signal(s, SIG_DFL);
    ::dup2(streams.in, 0), ::dup2(streams.out, 1), ::dup2(streams.err, 2);
    ::execvp(argv[0], argv.data());
    const int why = errno;
    if (::write(tell, &why, sizeof why) < 0) ::_exit(126);
    ::_exit(127);
}

}  // namespace

Process::Process(const std::vector<std::string>& words, const std::string& stdin_file, const std::string& stdout_file,
    const std::string& stderr_file) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    Descriptors streams;
    int feed[2] = {-1, -1}, tell[2];
    if (stdin_file.empty()) {
        if (!make_pipe(feed)) throw OutputError("no pipe to be had");
        streams.in = feed[0], streams.feed = feed[1];
    } else {
        streams.in = opened(stdin_file, O_RDONLY);
    }
    streams.out = opened(stdout_file, O_WRONLY | O_CREAT | O_TRUNC);
    streams.err = opened(stderr_file, O_WRONLY | O_CREAT | O_TRUNC);
    if (!make_pipe(tell)) throw OutputError("no pipe to be had");
    pid_ = ::fork();
    if (pid_ == 0) become(argv, streams, tell[1]);
    ::close(tell[1]);
    int why = pid_ < 0 ? errno : 0;
    if (pid_ > 0 && ::read(tell[0], &why, sizeof why) != static_cast<ssize_t>(sizeof why)) why = 0;
    ::close(tell[0]);
    if (why != 0) {
        if (pid_ > 0) ::waitpid(pid_, nullptr, 0);
        pid_ = -1;
        throw OutputError(fmt::format("cannot start {}: {}", words[0], std::strerror(why)));
    }
    pipe_ = std::exchange(streams.feed, -1);
}

Process::~Process() {
    if (pipe_ >= 0) ::close(pipe_);
    if (pid_ <= 0) return;
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
}

bool Process::write(const unsigned char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t n = ::write(pipe_, bytes, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes += n, size -= static_cast<std::size_t>(n);
    }
    return true;
}

int Process::wait(const ProgressMonitor& monitor) {
    if (pipe_ >= 0) ::close(pipe_);
    pipe_ = -1;
    int status = 0;
    while (::waitpid(pid_, &status, WNOHANG) == 0) {
        monitor.check();
        ::usleep(2000);
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace crescent::film
