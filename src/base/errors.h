// Error types. A mistake in the input is an InputError, with its place in the user's file (exit code 2); a defect of
// the program is a Bug, with its place in the source. A missing part or a place that cannot be written is an
// OutputError (exit code 3).
#pragma once

#include <source_location>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// The place of a value: file, line and column, both counted from 1 (0: unknown).
struct SourceLocation {
    std::string file;
    unsigned line = 0, column = 0;
};

/// Returns "gallery.toml:14:9", or as much of it as is known.
std::string to_string(const SourceLocation& place);

/// One mistake in the input: where, and what was expected.
struct Diagnostic {
    /// Mistakes for which a front end knows a remedy in its own terms.
    enum class Kind { other, unknown_name, misspelt_name, box_off_image };
    SourceLocation location;
    std::string message;
    Kind kind = Kind::other;
    std::string path{};  // of the key or the table in an experiment
};

/// The input is wrong. Contains every mistake found, in file order.
class InputError : public std::invalid_argument {
public:
    /// what() has one line per mistake.
    explicit InputError(std::vector<Diagnostic> diagnostics);
    InputError(const SourceLocation& place, const std::string& message)
        : InputError(std::vector<Diagnostic>{{place, message}}) {}
    /// In file order; at least one.
    const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

private:
    std::vector<Diagnostic> diagnostics_;
};

/// A file of images has no layer of this name, or several.
struct LayerError : InputError {
    using InputError::InputError;
};

/// Something could not be written, or a needed part (font, driver, library) is missing.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Returns the error of a part that this build leaves out; `part` starts the sentence: "crescent film".
OutputError not_built(std::string_view part);

/// An invariant of the program does not hold; what() contains file and line of the source.
class Bug : public std::logic_error {
public:
    Bug(const std::source_location& place, std::string_view claim);
};

/// Throws Bug if an invariant does not hold, in release builds too.
inline void ensure(
    bool holds, std::string_view claim, const std::source_location& place = std::source_location::current()) {
    if (!holds) throw Bug(place, claim);
}

/// Returns the word of `valid` nearest to `word` by edit distance, "" if none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& valid);

}  // namespace crescent
