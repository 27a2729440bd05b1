// Text from elsewhere, made fit for XML and HTML, for a terminal and for a shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline base {

/// For XML and XHTML-compatible HTML: & < > " ' as references; control characters that XML 1.0 forbids, and broken
/// UTF-8, as U+FFFD.
std::string escape(std::string_view text);

/// For one line of a terminal: valid UTF-8 in which nothing moves the cursor, sets a colour or turns the direction of
/// writing. Control characters (C0, DEL, C1, U+2028 to U+202E, U+2066 to U+2069) and broken bytes are shown as \xNN or
/// \u{N}. At most `longest` bytes of `text` are taken, cut between characters.
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);
/// The same for text of several lines: tabs and newlines stay.
std::string printable_lines(std::string_view text);

/// The word as a POSIX shell reads it back: as it is where that is plain, else in quotes.
std::string shell_word(std::string_view word);

// ---- What is said of a word that is none of those that are known.

/// "; did you mean 'phong'?" for the word of `valid` that is nearest; "" where none is near, or `word` is one of them.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid);

/// "expected one of uniform, cosine, phong, not 'phonk'; did you mean 'phong'?"; control characters are taken out of
/// `word`.
std::string expected_one_of(const std::vector<std::string>& valid, std::string_view word);

}  // namespace crescent::inline base
