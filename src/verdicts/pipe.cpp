#include "verdicts/pipe.h"

#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/text.h"
#include "verdicts/child.h"
#include "verdicts/pipe_text.h"

namespace crescent {

namespace {

using Clock = std::chrono::steady_clock;

class PipeSubject : public JudgedSampler {
public:
    PipeSubject(const std::string& command, const PipeLimits& limits) : limits_(limits), child_(command) {
        try {
            greet();
        } catch (const SubjectFault&) {
            const bool unknown = broken_.find("exit code 127") != std::string::npos ||
                broken_.find("exit code 126") != std::string::npos;
            stop();
            if (unknown && !greeted_)
                throw InputError({"--exec", 0, 0}, "the shell cannot start '" + printable(command) + "'");
            throw;
        } catch (...) {
            stop();
            throw;
        }
    }
    ~PipeSubject() override { stop(); }
    PipeSubject(const PipeSubject&) = delete;
    PipeSubject& operator=(const PipeSubject&) = delete;

    std::string name() const override { return name_; }
    bool serial() const override { return true; }
    bool has_f() const override { return has_f_; }
    Spending spending() const override { return {requests_, seconds_since(began_), limits_.total_seconds}; }

    void sample(int, Vec3d wo, std::span<const Vec2d> u, std::span<Draw> out) const override {
        ask(
            u.size(), "four numbers 'wix wiy wiz pdf'",
            [&](std::size_t i, std::string& line) {
                line = "sample";
                for (double v : {wo.x, wo.y, wo.z, u[i].x, u[i].y}) append(line, v);
            },
            [&](std::size_t i, std::string_view s) {
                Draw& d = out[i];
                return take_float(s, d.wi.x) && take_float(s, d.wi.y) && take_float(s, d.wi.z) &&
                    take_float(s, d.pdf) && blank(s);
            });
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override { values("pdf", at, out); }
    void f(std::span<const Pair> at, std::span<double> out) const override { values("f", at, out); }

private:
    PipeLimits limits_;
    std::string name_;
    bool has_f_ = false;
    Child child_;
    mutable std::string incoming_;
    mutable std::size_t read_from_ = 0;
    mutable std::uint64_t requests_ = 0;
    mutable std::string broken_;  // what went wrong; nothing is asked from then on
    bool greeted_ = false;
    Clock::time_point began_ = Clock::now();
    mutable bool slow_ = false;  // given up for want of time alone

    static double seconds_since(Clock::time_point then) {
        return std::chrono::duration<double>(Clock::now() - then).count();
    }

    static void one_pair(std::string& line, const Pair& p) {
        for (double v : {p.wo.x, p.wo.y, p.wo.z, p.wi.x, p.wi.y, p.wi.z}) append(line, v);
    }
    void values(const char* verb, std::span<const Pair> at, std::span<double> out) const {
        ask(
            at.size(), "one number",
            [&](std::size_t i, std::string& line) {
                line = verb;
                one_pair(line, at[i]);
            },
            [&](std::size_t i, std::string_view s) { return take_float(s, out[i]) && blank(s); });
    }

    /// What it had time to say is read no more; half a second to end by itself, unless it was given up.
    void stop() { child_.end(broken_.empty() ? 500 : 0); }

    void greet() {
        ask(
            1, "'hello 1 NAME'", [](std::size_t, std::string& line) { line = "hello 1"; },
            [&](std::size_t, std::string_view s) {
                if (s.substr(0, 8) != "hello 1 " || blank(s.substr(8))) return false;
                name_ = printable(s.substr(s.find_first_not_of(" \t", 8)), 60);
                return true;
            });
        greeted_ = true;
        ask(
            1, "one number, or '-' where there is no BRDF",
            [](std::size_t, std::string& line) {
                line = "f";
                one_pair(line, {{0, 0, 1}, {0, 0, 1}});
            },
            [&](std::size_t, std::string_view s) {
                double v = 0;
                has_f_ = s != "-";
                return !has_f_ || (take_float(s, v) && blank(s));
            });
    }

    using Write = std::function<void(std::size_t, std::string&)>;
    using Read = std::function<bool(std::size_t, std::string_view)>;

    [[noreturn]] void fault(
        const Write& write, std::size_t i, const std::string& what, std::string_view expected) const {
        std::string request;
        write(i, request);
        broken_ = fmt::format("request {} ({}): expected {}, {}", requests_ + i + 1, shown(request), expected, what);
        throw SubjectFault(broken_);
    }

    /// "" while it runs.
    std::string how_it_ended(int milliseconds) const {
        const std::optional<int> status = child_.status(milliseconds);
        if (!status) return "";
        if (WIFSIGNALED(*status)) return fmt::format("the program was killed by signal {}", WTERMSIG(*status));
        const int code = WEXITSTATUS(*status);
        return fmt::format("the program ended with exit code {}", code) +
            (code > 128 && code < 160 ? fmt::format(" (signal {})", code - 128) : "");
    }
    std::string why_closed() const {
        const std::string how = how_it_ended(200);
        return how.empty() ? "the program closed its output" : how;
    }
    /// Why nothing comes: a program that went on in the background and ended itself, or one that keeps its answers.
    std::string why_silent() const {
        const std::string how = how_it_ended(0);
        if (!how.empty()) return ": " + how + ", and what it left running holds its output open and says nothing";
        return pending().empty() ? " (does it flush every answer?)" : "; half a line stands there: " + shown(pending());
    }

    /// Writes all requests and reads all answers, whichever side is ready.
    void ask(std::size_t count, std::string_view expected, const Write& write, const Read& read) const {
        if (slow_) throw SubjectTooSlow(broken_);
        if (!broken_.empty()) throw SubjectGone("the program was given up: " + broken_);
        std::string outgoing, line;
        std::size_t written = 0, sent = 0, answered = 0;
        Clock::time_point last = Clock::now();
        while (answered < count) {
            constexpr std::size_t ahead = 1 << 16;  // bytes of requests kept ready
            if (outgoing.size() - sent < ahead / 2) {
                outgoing.erase(0, sent);
                sent = 0;
                while (written < count && outgoing.size() < ahead) {
                    write(written++, line);
                    outgoing += line;
                    outgoing += '\n';
                }
            }
            pollfd ends[2] = {{child_.output(), POLLIN, 0},
                {child_.input(), static_cast<short>(sent < outgoing.size() ? POLLOUT : 0), 0}};
            const int ready = poll(ends, sent < outgoing.size() ? 2 : 1, 50);
            if (ready > 0 && (ends[1].revents & (POLLOUT | POLLERR)) != 0 && sent < outgoing.size()) {
                const ssize_t n = child_.write(std::string_view(outgoing).substr(sent));
                if (n > 0) sent += static_cast<std::size_t>(n);
                else if (n < 0 && errno == EPIPE && (ends[0].revents & POLLIN) == 0)
                    fault(write, answered, "but it closed its input: " + why_closed(), expected);
            }
            if (ready > 0 && (ends[0].revents & (POLLIN | POLLHUP)) != 0) {
                if (!fill()) fault(write, answered, end_of_output(), expected);
                last = Clock::now();
                take_lines(count, answered, written, expected, write, read);
            }
            if (limits_.stop && limits_.stop->load()) {
                broken_ = "interrupted";
                throw Interrupted{};
            }
            if (seconds_since(began_) > limits_.total_seconds) {
                broken_ = fmt::format(
                    "the program is too slow to judge: {:g} s are spent and it gives {:.2g} answers a second",
                    limits_.total_seconds, static_cast<double>(requests_ + answered) / seconds_since(began_));
                slow_ = true;
                throw SubjectTooSlow(broken_);
            }
            const double quiet = std::chrono::duration<double>(Clock::now() - last).count();
            if (quiet > (greeted_ ? limits_.quiet_seconds : limits_.hello_seconds))
                fault(write, answered, fmt::format("got nothing for {:.0f} s{}", quiet, why_silent()), expected);
        }
        if (!pending().empty() && pending().find('\n') != std::string_view::npos)
            fault(write, count - 1,
                "got more lines than were asked for: " + shown(pending().substr(0, pending().find('\n'))), expected);
        requests_ += count;
    }

    std::string end_of_output() const {
        return fmt::format(
            "but {}{}", why_closed(), pending().empty() ? "" : " in the middle of a line: " + shown(pending()));
    }
    std::string_view pending() const { return std::string_view(incoming_).substr(read_from_); }

    /// False at the end of the program's output.
    bool fill() const {
        incoming_.erase(0, read_from_);
        read_from_ = 0;
        char buffer[1 << 16];
        const ssize_t n = ::read(child_.output(), buffer, sizeof buffer);
        if (n < 0) return errno == EAGAIN || errno == EINTR;
        incoming_.append(buffer, static_cast<std::size_t>(n));
        return n > 0;
    }

    void take_lines(std::size_t count, std::size_t& answered, std::size_t written, std::string_view expected,
        const Write& write, const Read& read) const {
        for (;;) {
            const std::size_t end = incoming_.find('\n', read_from_);
            if (end == std::string::npos) {
                if (pending().size() > limits_.longest_line)
                    fault(write, std::min(answered, count - 1),
                        fmt::format("got a line of more than {} bytes: {}", limits_.longest_line, shown(pending())),
                        expected);
                return;
            }
            std::string_view text(incoming_.data() + read_from_, end - read_from_);
            if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
            if (answered >= written)
                fault(write, std::min(answered, count - 1), "unexpected extra line: " + shown(text), expected);
            if (answered >= count) return;
            if (!read(answered, text)) fault(write, answered, "got " + shown(text), expected);
            ++answered;
            read_from_ = end + 1;
        }
    }
};

}  // namespace

std::shared_ptr<const JudgedSampler> start_pipe(const std::string& command, const PipeLimits& limits) {
    return std::make_shared<PipeSubject>(command, limits);
}

}  // namespace crescent
