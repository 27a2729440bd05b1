// Patterns are matched by a search that remembers the places from which the rest does not match: the time is bounded by
// the product of the lengths of pattern and name, times the number of possible views.
#include "compare/file_pattern.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <dirent.h>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <string_view>
#include <sys/stat.h>

namespace crescent {

namespace {

using PieceKind = PatternPiece::Kind;
using Pieces = std::vector<PatternPiece>;

constexpr std::string_view view_field = "{view}";
constexpr std::size_t wildcards_most = 32, length_most = 4096;  // 4096: of a path on Linux

std::size_t byte_of(char c) { return static_cast<unsigned char>(c); }

/// Reads what stands between [ and ]. Throws InputError.
PatternPiece set_of(std::string_view content, std::string_view pattern, const SourceLocation& place) {
    PatternPiece out;
    out.kind = PieceKind::set;
    const bool is_negated = content.size() > 1 && content[0] == '!';
    if (is_negated) content.remove_prefix(1);
    for (std::size_t i = 0; i < content.size(); ++i) {
        const bool is_range = i + 2 < content.size() && content[i + 1] == '-';
        const std::size_t first = byte_of(content[i]), last = byte_of(content[is_range ? i + 2 : i]);
        if (last < first)
            throw InputError(place,
                fmt::format("expected a range in ascending order in the pattern '{}', found [{}]", pattern, content));
        for (std::size_t c = first; c <= last; ++c) out.set.set(c);
        if (is_range) i += 2;
    }
    if (is_negated) out.set.flip();
    out.set.reset(byte_of('/'));
    return out;
}

/// Returns the length of "%d" or "%04d" at the begin of the text; 0: there is none.
std::size_t digits_length(std::string_view text) {
    if (text.empty() || text[0] != '%') return 0;
    const std::size_t end = std::min(text.find_first_not_of("0123456789", 1), text.size());
    return end < text.size() && text[end] == 'd' ? end + 1 : 0;
}

void add_text(Pieces& to, std::string_view text) {
    if (to.empty() || to.back().kind != PieceKind::text) to.emplace_back();
    to.back().text += text;
}

/// Reads a part of a pattern without '/'.
Pieces pieces_of(std::string_view part, std::string_view pattern, const SourceLocation& place, bool has_views) {
    Pieces out;
    const auto add = [&](PieceKind kind) { out.emplace_back().kind = kind; };
    while (!part.empty()) {
        std::size_t length = 1;
        const std::size_t end = part[0] == '[' ? part.find(']', 2) : std::string_view::npos;
        if (has_views && part.starts_with(view_field)) {
            length = view_field.size();
            add(PieceKind::view);
        } else if (part[0] == '*') add(PieceKind::characters);
        else if (part[0] == '?') add(PieceKind::one);
        else if (const std::size_t digits = digits_length(part); digits > 0) {
            length = digits;
            add(PieceKind::digits);
        } else if (end != std::string_view::npos) {
            length = end + 1;
            const std::string_view content = part.substr(1, end - 1);
            if (content.size() == 1) add_text(out, content);
            else out.push_back(set_of(content, pattern, place));
        } else add_text(out, part.substr(0, 1));
        part.remove_prefix(length);
    }
    return out;
}

/// The parts of a text that match views and wildcards.
struct Match {
    std::optional<std::string> view;
    std::vector<std::string> wildcards;
};

/// Returns whether the name is hidden from a part that begins with a wildcard.
bool is_hidden(const Pieces& part, std::string_view name) {
    return name.starts_with('.') && part[0].kind != PieceKind::text;
}

/// Matches the pieces of one part of a path, or of all parts and the slashes between them.
class Matcher {
public:
    Matcher(const Pieces& pieces, std::string_view text, bool any_view)
        : pieces_(pieces), text_(text), any_view_(any_view) {}

    bool match(Match& out) {
        forget();
        return match_rest(0, 0, out);
    }

private:
    void forget() { failed_states_.assign((pieces_.size() + 1) * (text_.size() + 1), false); }

    bool match_rest(std::size_t piece, std::size_t from, Match& out) {
        if (piece == pieces_.size()) return from == text_.size();
        const std::size_t state = piece * (text_.size() + 1) + from;
        if (failed_states_[state]) return false;
        const bool matches = alternatives(piece, from, out);
        if (!matches) failed_states_[state] = true;
        return matches;
    }

    bool alternatives(std::size_t piece, std::size_t from, Match& out) {
        const PatternPiece& p = pieces_[piece];
        const std::size_t remaining = std::min(text_.find('/', from), text_.size()) - from;
        if (p.kind == PieceKind::text)
            return text_.substr(from).starts_with(p.text) && match_rest(piece + 1, from + p.text.size(), out);
        if (p.kind == PieceKind::view) return view(piece, from, remaining, out);
        if (p.kind == PieceKind::one || p.kind == PieceKind::set) {
            const bool fits = remaining > 0 && (p.kind == PieceKind::one || p.set[byte_of(text_[from])]);
            return fits && wildcard(piece, from, 1, out);
        }
        if (p.kind == PieceKind::digits) {
            std::size_t digit_count = 0;
            while (digit_count < remaining && text_[from + digit_count] >= '0' && text_[from + digit_count] <= '9')
                ++digit_count;
            for (std::size_t length = digit_count; length > 0; --length)
                if (wildcard(piece, from, length, out)) return true;
            return false;
        }
        for (std::size_t length = 0; length <= remaining; ++length)
            if (wildcard(piece, from, length, out)) return true;
        return false;
    }

    bool wildcard(std::size_t piece, std::size_t from, std::size_t length, Match& out) {
        out.wildcards.emplace_back(text_.substr(from, length));
        if (match_rest(piece + 1, from + length, out)) return true;
        out.wildcards.pop_back();
        return false;
    }

    /// The longest view that matches; each later {view} matches the same text.
    bool view(std::size_t piece, std::size_t from, std::size_t remaining, Match& out) {
        if (out.view)
            return text_.substr(from).starts_with(*out.view) && match_rest(piece + 1, from + out.view->size(), out);
        for (std::size_t length = remaining; length > 0; --length) {
            if (any_view_) {
                if (match_rest(piece + 1, from + length, out)) return true;
                continue;
            }
            out.view = text_.substr(from, length);
            const std::vector<bool> former_states = failed_states_;
            forget();
            if (match_rest(piece + 1, from + length, out)) return true;
            failed_states_ = former_states;
            out.view.reset();
        }
        return false;
    }

    const Pieces& pieces_;
    std::string_view text_;
    bool any_view_;  // the text of a view is not compared with that of others
    std::vector<bool> failed_states_;
};

bool is_text(const Pieces& part) { return part.size() == 1 && part[0].kind == PieceKind::text; }

std::vector<std::string_view> split_at_slashes(std::string_view text) {
    std::vector<std::string_view> out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('/'), text.size());
        if (end > 0) out.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

/// Returns the names in a folder; none if it does not exist. Throws InputError if it cannot be read.
std::vector<std::string> names_in(const std::string& folder) {
    const std::unique_ptr<DIR, int (*)(DIR*)> open(::opendir(folder.empty() ? "." : folder.c_str()), ::closedir);
    if (!open) {
        if (errno == ENOENT || errno == ENOTDIR) return {};
        throw InputError({folder, 0, 0}, fmt::format("expected a folder that can be read: {}", std::strerror(errno)));
    }
    std::vector<std::string> out;
    while (const dirent* entry = ::readdir(open.get()))
        if (const std::string_view name = entry->d_name; name != "." && name != "..") out.emplace_back(name);
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

FilePattern::FilePattern(std::string pattern, SourceLocation place, bool has_views)
    : text_(std::move(pattern)), location_(std::move(place)), rooted_(text_.starts_with('/')) {
    if (text_.size() > length_most)
        throw InputError(
            location_, fmt::format("expected a pattern of at most {} characters, found {}", length_most, text_.size()));
    std::size_t wildcards = 0;
    for (const std::string_view part : split_at_slashes(text_)) {
        parts_.push_back(pieces_of(part, text_, location_, has_views));
        for (const PatternPiece& piece : parts_.back()) wildcards += piece.kind != PieceKind::text;
    }
    if (wildcards > wildcards_most)
        throw InputError(location_,
            fmt::format(
                "expected at most {} wildcards in the pattern '{}', found {}", wildcards_most, text_, wildcards));
}

bool FilePattern::has_view() const {
    return std::any_of(parts_.begin(), parts_.end(), [](const Pieces& part) {
        return std::any_of(part.begin(), part.end(), [](const PatternPiece& p) { return p.kind == PieceKind::view; });
    });
}

void FilePattern::find_below(const std::string& folder, std::size_t part, std::vector<std::string>& out) const {
    const Pieces& pieces = parts_[part];
    const bool is_last = part + 1 == parts_.size();
    for (const std::string& name : is_text(pieces) ? std::vector{pieces[0].text} : names_in(folder)) {
        Match ignored;
        if (!is_text(pieces) && (is_hidden(pieces, name) || !Matcher(pieces, name, true).match(ignored))) continue;
        const std::string path = folder + name;
        struct stat s{};
        const bool exists = ::lstat(path.c_str(), &s) == 0;
        const bool is_folder = exists && ::stat(path.c_str(), &s) == 0 && S_ISDIR(s.st_mode);
        if (is_last && exists && !is_folder) out.push_back(path);
        if (!is_last && is_folder) find_below(path + "/", part + 1, out);
    }
}

std::optional<MatchedFile> FilePattern::match(const std::string& path) const {
    // {view} may be in several parts: all of them are matched as one text.
    const std::vector<std::string_view> names = split_at_slashes(path);
    if (names.size() != parts_.size() || rooted_ != path.starts_with('/')) return {};
    Pieces pieces;
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (is_hidden(parts_[k], names[k])) return {};
        if (k > 0) {
            pieces.push_back({PieceKind::text, "/", {}});
            text += '/';
        }
        pieces.insert(pieces.end(), parts_[k].begin(), parts_[k].end());
        text += names[k];
    }
    Match parts;
    if (!Matcher(pieces, text, false).match(parts)) return {};
    return MatchedFile{path, parts.view.value_or(""), std::move(parts.wildcards)};
}

std::vector<MatchedFile> FilePattern::find() const {
    std::vector<std::string> paths;
    if (!parts_.empty()) find_below(rooted_ ? "/" : "", 0, paths);
    std::sort(paths.begin(), paths.end());
    std::vector<MatchedFile> out;
    for (const std::string& path : paths)
        if (auto file = match(path)) out.push_back(std::move(*file));
    return out;
}

std::optional<std::string> FilePattern::path(const std::string& view, const std::vector<std::string>& wildcards) const {
    std::string out = rooted_ ? "/" : "";
    std::size_t next = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        if (k > 0) out += '/';
        for (const PatternPiece& piece : parts_[k]) {
            if (piece.kind == PieceKind::text) out += piece.text;
            else if (piece.kind == PieceKind::view) out += view;
            else if (next < wildcards.size()) out += wildcards[next++];
            else return {};
        }
    }
    if (next != wildcards.size()) return {};
    return out;
}

std::string FilePattern::folder() const {
    std::string out = rooted_ ? "/" : "";
    for (std::size_t k = 0; k + 1 < parts_.size() && is_text(parts_[k]); ++k)
        out += (k > 0 ? "/" : "") + parts_[k][0].text;
    return out.empty() ? "." : out;
}

std::string escape_pattern(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::string_view("*?[%{").find(c) == std::string_view::npos) out += c;
        else out += {'[', c, ']'};
    }
    return out;
}

std::string pattern_in(const std::string& folder, const std::string& pattern) {
    if (folder.empty() || pattern.starts_with('/')) return pattern;
    return escape_pattern(folder) + (folder.ends_with('/') ? "" : "/") + pattern;
}

}  // namespace crescent
