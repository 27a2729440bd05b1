// Makes external text safe for XML and HTML, for a terminal and for a shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// Escapes for XML and XHTML-compatible HTML: & < > " ' as references; control characters that XML 1.0 forbids, and
/// invalid UTF-8, as U+FFFD.
std::string escape(std::string_view text);

/// Returns text for one line of a terminal: valid UTF-8 in which nothing moves the cursor, sets a colour or changes the
/// direction of writing. Control characters (C0, DEL, C1, U+2028 to U+202E, U+2066 to U+2069) and invalid bytes are
/// shown as \xNN or \u{N}. At most `longest` bytes of `text` are used, cut between characters.
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);
/// Like printable() for text of several lines: tabs and newlines stay.
std::string printable_lines(std::string_view text);

/// Returns the word as a POSIX shell reads it back: unchanged if it is plain, else in quotes.
std::string shell_word(std::string_view word);

// ---- Messages about an unknown word.

/// Returns "; did you mean 'phong'?" for the nearest word of `valid`; "" if none is near, or if `word` is one of them.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid);

/// Returns "expected one of uniform, cosine, phong, not 'phonk'; did you mean 'phong'?"; control characters are removed
/// from `word`.
std::string expected_one_of(const std::vector<std::string>& valid, std::string_view word);

}  // namespace crescent
