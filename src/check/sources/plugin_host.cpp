// dlopen() and dlsym(); one thread calls the functions of sampler_plugin.h, block by block. The pipes are moved to
// separate descriptors before the plugin is loaded, and its stdout goes to stderr. A second thread ends the process
// group if crescent exits, also during a call. Does not depend on other code of crescent, so that it is also a small
// program.
#include "check/sources/plugin_host.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cfenv>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "check/sampler_plugin.h"

namespace crescent {

const char* const plugin_host_name = "crescent-plugin-host";

namespace {

/// Ends the host and all processes that the plugin started in its group. Exit handlers do not run, because there may be
/// threads.
[[noreturn]] void end_group() {
    if (::getpgrp() == ::getpid()) ::kill(0, SIGKILL);
    ::_exit(0);
}

[[noreturn]] void leave() {
    std::fflush(nullptr);  // flush the output of the plugin
    end_group();
}

/// The pipes to crescent.
struct Pipes {
    int in = ::fcntl(0, F_DUPFD_CLOEXEC, 64), out = ::fcntl(1, F_DUPFD_CLOEXEC, 64);

    /// Returns false at the end of the input.
    bool read(void* to, std::size_t size) const {
        for (auto* free_bytes = static_cast<char*>(to); size > 0;) {
            const ssize_t n = ::read(in, free_bytes, size);
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) return false;
            free_bytes += n;
            size -= static_cast<std::size_t>(n);
        }
        return true;
    }
    void write(const void* from, std::size_t size) const {
        for (const auto* position = static_cast<const char*>(from); size > 0;) {
            const ssize_t n = ::write(out, position, size);
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) leave();
            position += n;
            size -= static_cast<std::size_t>(n);
        }
    }
    void write(const std::string& text) const { write(text.data(), text.size()); }
};

/// Waits until the other end of the input is closed. An idle host then ends by itself.
void* watch(void* input) {
    pollfd end{*static_cast<int*>(input), 0, 0};
    while (::poll(&end, 1, -1) < 0) {}
    const timespec moment{0, 200'000'000};
    ::nanosleep(&moment, nullptr);
    end_group();
}

/// The program that contains this code may have installed handlers already.
void reset_signals() {
    for (int s = 1; s < NSIG; ++s) ::signal(s, SIG_DFL);
}

void start_watching(int& input) {
    sigset_t signals, old_signals;
    sigfillset(&signals);
    pthread_sigmask(SIG_SETMASK, &signals, &old_signals);  // signals are for the plugin's thread
    pthread_t thread;
    if (pthread_create(&thread, nullptr, watch, &input) != 0) ::_exit(1);
    pthread_sigmask(SIG_SETMASK, &old_signals, nullptr);
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, 0);  // it would end this process alone, but not its group
#endif
}

struct Fault {
    std::string text, function = "";  // the called function; "": none
};

/// Calls a function of the plugin with the default floating-point environment.
template <class Call> auto called(const char* function, Call&& call) {
    const pid_t self = ::getpid();
    const auto require_same_process = [&] {
        if (::getpid() != self) ::_exit(0);  // a child process of the plugin that returned here too
    };
    std::fesetenv(FE_DFL_ENV);
    try {
        const auto result = call();
        require_same_process();
        return result;
    } catch (const std::exception& e) {
        require_same_process();
        throw Fault{std::string("threw '") + e.what() + "'", function};
    } catch (...) {
        require_same_process();
        throw Fault{"threw something", function};
    }
}

struct Library {
    using Answer = int (*)(size_t, const double*, const double*, const double*, double*);
    int (*sample)(size_t, const double*, const double*, const double*, double*, double*) = nullptr;
    Answer pdf = nullptr, f = nullptr;
    unsigned numbers = 2;
    bool is_serial = false;
    std::string name, uses;

    explicit Library(const std::string& path) {
        // For a name without a slash dlopen would search the system's libraries.
        const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
        struct stat info{};
        if (::stat(file.c_str(), &info) == 0 && !S_ISREG(info.st_mode))  // dlopen() of a named pipe waits for a writer
            throw Fault{"expected a regular file"};
        void* library = called("dlopen", [&] { return ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); });
        if (!library) throw Fault{::dlerror()};
        const auto find = [&]<class F>(const char* symbol, F& to) {
            to = reinterpret_cast<F>(::dlsym(library, symbol));
            return to != nullptr;
        };
        unsigned (*give_abi)() = nullptr, (*give_numbers)() = nullptr;
        int (*give_serial)() = nullptr;
        const char* (*give_name)() = nullptr, *(*give_uses)() = nullptr;
        if (!find("crescent_sampler_abi", give_abi)) throw missing("crescent_sampler_abi");
        const unsigned version = called("crescent_sampler_abi", give_abi);
        if (version != CRESCENT_SAMPLER_ABI)
            throw Fault{"it has version " + std::to_string(version) + " of the interface; this program has version " +
                std::to_string(CRESCENT_SAMPLER_ABI) + ": compile it with the sampler_plugin.h of this program"};
        if (find("crescent_sampler_uses", give_uses)) uses = text_of("crescent_sampler_uses", give_uses);
        if (uses.find_first_of(" \n") != std::string::npos)
            throw Fault{"crescent_sampler_uses gives '" + uses + "': expected names separated by commas"};
        if (!find("crescent_sampler_sample", sample)) throw missing("crescent_sampler_sample");
        find("crescent_sampler_pdf", pdf);
        find("crescent_sampler_f", f);
        if (find("crescent_sampler_numbers", give_numbers)) numbers = called("crescent_sampler_numbers", give_numbers);
        if (numbers < 1 || numbers > 8)
            throw Fault{"it takes " + std::to_string(numbers) + " random numbers a sample: expected 1 to 8"};
        if (find("crescent_sampler_serial", give_serial))
            is_serial = called("crescent_sampler_serial", give_serial) != 0;
        if (find("crescent_sampler_name", give_name)) name = text_of("crescent_sampler_name", give_name);
        if (name.empty()) name = path.substr(path.rfind('/') + 1);
        std::replace(name.begin(), name.end(), '\n', ' ');
    }

    /// Returns the text that a function gives; a text without an end is a fault as well.
    static std::string text_of(const char* function, const char* (*give)()) {
        constexpr std::size_t longest = 200;
        const char* text = called(function, give);
        const std::size_t size = text ? ::strnlen(text, longest + 1) : 0;
        if (size > longest) throw Fault{std::string(function) + " gives a text of more than 200 bytes"};
        return {text ? text : "", size};
    }

    static Fault missing(const char* function) {
        return {std::string("it has no function ") + function + ": see sampler_plugin.h"};
    }
};

/// The columns that the rows of a request share, one copy for each row. Reused, so that memory is allocated once.
struct Columns {
    std::vector<double> run, wo, surface;

    bool read(const Pipes& pipes, const PluginRequest& request) {
        const std::size_t columns = request.columns;
        wo.resize(3 * request.rows);
        surface.resize(columns * request.rows);
        run.resize((4 + columns) * request.runs);
        if (!pipes.read(run.data(), run.size() * sizeof(double))) return false;
        std::size_t row = 0;
        for (const double* r = run.data(); r != run.data() + run.size(); r += 4 + columns)
            for (auto remaining = static_cast<std::size_t>(r[0]); remaining > 0 && row < request.rows;
                --remaining, ++row) {
                std::copy_n(r + 1, 3, &wo[3 * row]);
                std::copy_n(r + 4, columns, surface.data() + columns * row);
            }
        return true;
    }
};

void answer(
    const Pipes& pipes, const Library& library, const PluginRequest& request, const Columns& columns, void* memory) {
    const char* function = "crescent_sampler_sample";
    Library::Answer evaluate = nullptr;
    if (request.operation == 'p') {
        function = "crescent_sampler_pdf";
        evaluate = library.pdf;
    }
    if (request.operation == 'f') {
        function = "crescent_sampler_f";
        evaluate = library.f;
    }
    const std::size_t n = request.rows;
    const PluginRows rows(memory, n, evaluate ? 3 : library.numbers);
    const int code = called(function, [&] {
        if (evaluate) return evaluate(n, columns.wo.data(), rows.input, columns.surface.data(), rows.values);
        return library.sample(n, columns.wo.data(), rows.input, columns.surface.data(), rows.wi, rows.values);
    });
    if (code != 0) throw Fault{"gave " + std::to_string(code) + ", expected 0,"};
    const PluginAnswer head{request.rows, 0};
    pipes.write(&head, sizeof head);
}

std::string handshake(const Library& library) {
    const auto number = [](const char* key, unsigned value) { return key + std::to_string(value) + " "; };
    return plugin_handshake + number("numbers=", library.numbers) + number("pdf=", library.pdf != nullptr) +
        number("f=", library.f != nullptr) + number("serial=", library.is_serial) +
        (library.uses.empty() ? "" : "uses=" + library.uses + " ") + "name=" + library.name + "\n";
}

/// Loads the plugin permanently: it may have threads, so it is never unloaded.
const Library& load(const Pipes& pipes, const char* path) {
    try {
        const Library* library = new Library(path);
        pipes.write(handshake(*library));
        return *library;
    } catch (Fault& fault) {
        const std::string function = fault.function.empty() ? "" : fault.function + " ";
        std::replace(fault.text.begin(), fault.text.end(), '\n', ' ');
        pipes.write(std::string(plugin_handshake) + "error " + function + fault.text + "\n");
    }
    leave();
}

}  // namespace

void serve_plugin(const char* path) {
    static Pipes pipes;
    void* memory = ::mmap(nullptr, PluginRows::bytes, PROT_READ | PROT_WRITE, MAP_SHARED, 3, 0);
    if (memory == MAP_FAILED) ::_exit(1);
#ifdef __linux__
    // A child process that the plugin forks in a call, and that goes on in it, would write over later answers.
    ::madvise(memory, PluginRows::bytes, MADV_DONTFORK);
#endif
    ::close(3);
    const int null_input = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    ::dup2(null_input, 0);
    ::dup2(2, 1);
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    reset_signals();
    start_watching(pipes.in);
    const Library& library = load(pipes, path);
    try {
        Columns columns;
        for (PluginRequest request{}; pipes.read(&request, sizeof request) && columns.read(pipes, request);)
            answer(pipes, library, request, columns, memory);
    } catch (const Fault& fault) {
        const PluginAnswer head{0, static_cast<std::uint32_t>(fault.text.size())};
        pipes.write(&head, sizeof head);
        pipes.write(fault.text);
    }
    leave();
}

namespace {

/// Runs before main() and the constructors of the program that contains this code. glibc and macOS pass the arguments.
[[gnu::constructor(101)]] void serve_if_host(int count, char** words) {
    if (count == 2 && std::strcmp(words[0], plugin_host_name) == 0) serve_plugin(words[1]);
}

}  // namespace

}  // namespace crescent

#ifdef CRESCENT_PLUGIN_HOST_PROGRAM
int main() {
    std::fputs(
        "crescent-plugin-host: crescent starts this program to run a plugin in it; see docs/plugins.md\n", stderr);
    return 2;
}
#endif
