// Patterns of file names: *, ?, [abc], [a-z], [!abc], %d and %04d (digits), and {view}, the name of a view. A wildcard
// does not match '/', and at the begin of a name no '.'. [c] with one character is that character: a folder
// whose name has wildcards is written so.
#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"

namespace crescent {

/// One piece of a pattern.
struct PatternPiece {
    enum class Kind { text, view, characters, one, digits, set } kind = Kind::text;
    std::string text;      // of text
    std::bitset<256> set;  // of a set: its bytes
    bool operator==(const PatternPiece&) const = default;
};

/// A file that matches a pattern: its view, and the matches of its other wildcards, in order.
struct MatchedFile {
    std::string path, view;
    std::vector<std::string> wildcards;
};

class FilePattern {
public:
    /// Throws InputError at `place` for a set that is no set, such as [z-a], and for more than 32 wildcards. Without
    /// `has_views`, {view} is text.
    FilePattern(std::string pattern, SourceLocation place, bool has_views);

    const std::string& text() const { return text_; }
    const SourceLocation& location() const { return location_; }
    bool has_view() const;
    /// Returns the files that match, sorted by path. Throws InputError if a folder cannot be read.
    std::vector<MatchedFile> find() const;
    /// Returns the parts of a path; nothing if it does not match.
    std::optional<MatchedFile> match(const std::string& path) const;
    /// Returns the path with this view and these wildcards; nothing if their numbers differ.
    std::optional<std::string> path(const std::string& view, const std::vector<std::string>& wildcards) const;
    /// Returns the folder of all paths that match: the part before the first wildcard.
    std::string folder() const;

private:
    using Pieces = std::vector<PatternPiece>;
    void find_below(const std::string& folder, std::size_t part, std::vector<std::string>& out) const;

    std::string text_;
    SourceLocation location_;
    std::vector<Pieces> parts_;  // between slashes
    bool rooted_ = false;        // begins with '/'
};

/// Returns a pattern that matches this text only.
std::string escape_pattern(const std::string& text);

/// Returns the pattern below a folder, whose name is text; the pattern itself if it begins with '/'.
std::string pattern_in(const std::string& folder, const std::string& pattern);

}  // namespace crescent
