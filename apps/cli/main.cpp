// The program `crescent`: runs the command and returns its exit code.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <unistd.h>

#include "arguments.h"
#include "commands.h"
#include "crescent/crescent.h"
#include "signals.h"

namespace crescent::cli {

void print(const std::string& text) { print_as_it_is(printable_lines(text)); }

void print_as_it_is(const std::string& text) {
    errno = 0;
    const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!is_written && errno != EPIPE)
        throw OutputError(std::string("cannot write to stdout: ") + std::strerror(errno));
}

void print_to_stderr(const std::string& text) { std::fputs(printable_lines(text).c_str(), stderr); }

namespace {

/// Opens descriptors 0, 1 and 2 if they are closed: the first opened file would otherwise get their number.
void open_standard_streams() {
    for (int fd = 0; fd <= 2; ++fd)
        if (::fcntl(fd, F_GETFD) == -1 && errno == EBADF) static_cast<void>(::open("/dev/null", O_RDWR));
}

int ended_with(int code, const std::string& text) {
    print_to_stderr(text + "\n");
    return code;
}

int perform(int argc, char** argv) {
    try {
        return parse(argc, argv)();
    } catch (const InputError& e) { return ended_with(misused, e.what()); } catch (const OutputError& e) {
        return ended_with(unwritable, std::string("crescent: ") + e.what());
    } catch (const Interrupted&) {
        return ended_with(interrupted, "crescent: interrupted; existing outputs were not changed");
    } catch (const std::bad_alloc&) {
        return ended_with(unwritable, "crescent: out of memory");
    } catch (const std::exception& e) {
        return ended_with(bug, std::string("crescent: internal error, please report it: ") + e.what());
    }
}

}  // namespace
}  // namespace crescent::cli

int main(int argc, char** argv) {
    crescent::cli::open_standard_streams();
    for (const int failed_write : {SIGPIPE, SIGXFSZ}) std::signal(failed_write, SIG_IGN);  // write() reports these too
    crescent::cli::end_on_signals();
    crescent::Process::adopt_orphans();
    const int code = crescent::cli::perform(argc, argv);
    crescent::Process::kill_all();
    return code;
}
