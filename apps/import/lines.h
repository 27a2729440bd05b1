// The lines of OBJ and MTL files, and words of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::importer {

/// A statement: its first word, and what follows without blanks at the ends.
struct Statement {
    std::size_t line = 0;  // from 1 on
    std::string_view key, value;
};

/// Returns the text without byte order mark, with '\n' as the end of each line. Lines that a backslash continues are
/// joined; the lines that were joined follow as empty ones, so that numbers of lines stay. A line that begins with '#'
/// is a comment and is not continued: it becomes empty.
std::string joined_lines(std::string_view text, bool backslash_continues = true);

/// Gives the statements of a text with joined lines, one after the other.
class Statements {
public:
    explicit Statements(std::string_view text) : text_(text) {}
    /// The next one; nothing at the end.
    std::optional<Statement> next();

private:
    std::string_view text_;
    std::size_t line_ = 0;
};

std::string lower_case(std::string_view word);
std::string_view without_blanks_at_ends(std::string_view text);
/// Of a name: "a b.png" has them in some files.
std::string_view without_quotes(std::string_view text);
/// Before '#'.
std::string_view without_comment(std::string_view text);
/// Before '#' behind a blank: a name may have one within.
std::string_view without_comment_of_name(std::string_view text);
/// Takes the first word off.
std::string_view take_word(std::string_view& text);
std::vector<std::string_view> words_of(std::string_view text);
/// The numbers that all words are; nothing if one of them is none.
std::optional<std::vector<double>> numbers_of(std::string_view text);

}  // namespace crescent::importer
