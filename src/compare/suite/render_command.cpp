// One thread for each program that runs at a time.
#include "compare/suite/render_command.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>

#include "base/errors.h"
#include "base/process.h"
#include "base/text.h"
#include "compare/renders.h"

namespace crescent {

namespace {

using Clock = std::chrono::steady_clock;

bool contains(const std::vector<std::string>& words, std::string_view text) {
    return std::any_of(
        words.begin(), words.end(), [&](const std::string& word) { return word.find(text) != std::string::npos; });
}

/// Replaces each {view}, {seed} and {out} of a word; what is put in is not read again.
std::string with_values(
    const std::string& word, const std::string& view, const std::string& seed, const std::string& out) {
    const std::pair<std::string_view, const std::string*> values[] = {
        {"{view}", &view}, {"{seed}", &seed}, {"{out}", &out}};
    std::string result;
    for (std::size_t i = 0; i < word.size();) {
        const auto* match = std::find_if(std::begin(values), std::end(values),
            [&](const auto& value) { return std::string_view(word).substr(i).starts_with(value.first); });
        if (match == std::end(values)) result += word[i++];
        else {
            result += *match->second;
            i += match->first.size();
        }
    }
    return result;
}

/// Removes the ending of a picture from "{out}.png" in a word, and returns it without the dot; "" if there is none.
std::string take_extension(std::string& word) {
    constexpr std::string_view out = "{out}";
    const std::size_t position = word.find(out);
    if (position == std::string::npos) return "";
    const std::size_t end = position + out.size();
    const auto ending = std::ranges::find(image_endings, std::string_view(word).substr(end));
    if (ending == image_endings.end()) return "";
    word.erase(end);
    return *ending + 1;
}

/// The last line that a program wrote to its standard error; "" if there is none.
std::string last_line(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::string line, last;
    constexpr std::size_t longest = 200;
    while (std::getline(in, line))
        if (!line.empty()) last = line;
    return printable(last, longest);
}

RenderEnd run_program(const RenderJob& job, const RenderLimits& limits, const ProgressMonitor& monitor) {
    namespace fs = std::filesystem;
    RenderEnd out;
    if (Clock::now() >= limits.end) return out;
    const fs::path target(job.out);
    std::error_code error;
    const fs::path folder = target.parent_path().empty() ? "." : target.parent_path();
    fs::create_directories(folder, error);
    if (error) throw OutputError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
    // A pattern matches no name that begins with a dot; the extension stays, because programs look at it.
    const fs::path partial = target.parent_path() / (".crescent-partial-" + target.filename().string());
    const std::string log = partial.string() + ".log";
    const auto clear = [&] {
        std::error_code ignored;
        fs::remove(partial, ignored);
        fs::remove(log, ignored);
    };
    clear();
    const Clock::time_point begin = Clock::now();
    try {
        Process program({.argv = job.command->for_render(job.view, job.seed, partial.string()),
            .stdin_file = "/dev/null",
            .stdout_file = "/dev/null",
            .stderr_file = log});
        std::optional<ProcessEnd> end;
        const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
        constexpr int patience = 20;  // milliseconds between two looks at the process
        while (!end) {
            monitor.check();
            end = program.ended(patience);
            if (end) break;
            if (Clock::now() >= limits.end) {
                out.seconds = seconds();
                out.is_stopped = true;
                return clear(), out;
            }
            if (seconds() > limits.timeout) {
                out.failure = fmt::format("did not end within {} s", limits.timeout);
                return clear(), out;
            }
        }
        out.seconds = seconds();
        if (!end->well()) {
            const std::string message = last_line(log);
            out.failure = fmt::format("ended with {}{}", end->text(), message.empty() ? "" : ": " + message);
        } else if (!fs::exists(partial)) out.failure = "wrote no file";
        else {
            (void)read_render(partial.string(), limits.layer, limits.reading);
            fs::rename(partial, target, error);
            out.is_made = !error;
            if (error)
                out.failure = fmt::format("wrote a file that cannot become {}: {}", target.string(), error.message());
        }
    } catch (const InputError& mistake) {
        out.failure = "wrote a file that cannot be read: " + std::string(mistake.diagnostics().front().message);
    } catch (const OutputError& failure) { out.failure = failure.what(); } catch (...) {
        clear();
        throw;
    }
    clear();
    return out;
}

}  // namespace

bool RenderCommand::has_view() const { return contains(words, "{view}"); }
bool RenderCommand::has_seed() const { return contains(words, "{seed}"); }

std::vector<std::string> RenderCommand::for_render(
    const std::string& view, std::uint64_t seed, const std::string& out) const {
    std::vector<std::string> result;
    for (const std::string& word : words) result.push_back(with_values(word, view, std::to_string(seed), out));
    return result;
}

RenderCommand parse_render_command(const std::string& text, const std::string& flag) {
    RenderCommand out{text, {}, {}};
    const auto fail = [&](const std::string& message) { throw InputError({flag, 0, 0}, message); };
    std::string word;
    bool has_begun = false;
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool escapes = c == '\\' && quote != '\'';
        if (escapes && i + 1 == text.size()) fail("expected a character after the last backslash");
        if (escapes) {
            word += text[++i];
            has_begun = true;
        } else if (quote && c == quote) quote = 0;
        else if (quote) word += c;
        else if (c == '\'' || c == '"') {
            quote = c;
            has_begun = true;
        } else if (c != ' ' && c != '\t' && c != '\n') {
            word += c;
            has_begun = true;
        } else if (has_begun) {
            out.words.push_back(std::move(word));
            word.clear();
            has_begun = false;
        }
    }
    if (quote) fail(fmt::format("expected the end of the text in {}", quote));
    if (has_begun) out.words.push_back(std::move(word));
    if (out.words.empty()) fail("expected a command");
    if (!contains(out.words, "{out}")) fail("expected {out}, the file to write, in the command");
    for (std::string& entry : out.words) {
        const std::string extension = take_extension(entry);
        if (extension.empty()) continue;
        if (!out.extension.empty() && out.extension != extension)
            fail(fmt::format("expected one ending of {{out}}, found .{} and .{}", out.extension, extension));
        out.extension = extension;
    }
    return out;
}

std::vector<RenderEnd> make_renders(
    const std::vector<RenderJob>& jobs, const RenderLimits& limits, const ProgressMonitor& monitor) {
    std::vector<RenderEnd> out(jobs.size());
    std::atomic<std::size_t> next = 0;
    std::mutex lock;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t k = next++; k < jobs.size(); k = next++) {
            try {
                out[k] = run_program(jobs[k], limits, monitor);
            } catch (...) {
                const std::lock_guard guard(lock);
                failure = std::current_exception();
                next = jobs.size();
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        const std::size_t count = std::min(jobs.size(), static_cast<std::size_t>(std::max(1, limits.jobs)));
        for (std::size_t t = 0; t < count; ++t) threads.emplace_back(work);
    }
    if (failure) std::rethrow_exception(failure);
    return out;
}

}  // namespace crescent
