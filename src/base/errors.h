// Two kinds of error. The reader's mistake points into the reader's file (InputError, exit code 2);
// ours points into our source (Bug). A part that is missing or a place that cannot be written is an
// OutputError (exit code 3).
#pragma once

#include <source_location>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline base {

/// Where a value stands: file, line and column, both counted from 1 (0: unknown).
struct SourceLocation {
    std::string file;
    unsigned line = 0, column = 0;
};

/// "gallery.toml:14:9", or as much of it as is known.
std::string to_string(const SourceLocation& at);

/// One mistake in the input: where, and what was expected.
struct Diagnostic {
    SourceLocation at;
    std::string message;
};

/// The input is wrong. Carries every mistake that was found, in file order.
class InputError : public std::invalid_argument {
public:
    /// what() has a line a mistake.
    explicit InputError(std::vector<Diagnostic> all);
    InputError(const SourceLocation& at, const std::string& message)
        : InputError(std::vector<Diagnostic>{{at, message}}) {}
    /// In file order; at least one.
    const std::vector<Diagnostic>& diagnostics() const { return all_; }

private:
    std::vector<Diagnostic> all_;
};

/// Something could not be written, or a needed part (font, driver, library) is missing.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A claim of ours did not hold: file and line of our own source are in what().
class Bug : public std::logic_error {
public:
    Bug(const std::source_location& at, std::string_view claim);
};

/// Stop here if a claim about our own code does not hold, in release builds too.
inline void ensure(
    bool holds, std::string_view claim, const std::source_location& at = std::source_location::current()) {
    if (!holds) throw Bug(at, claim);
}

/// The word of `valid` nearest to `word` by edit distance, "" where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& valid);

}  // namespace crescent::inline base
