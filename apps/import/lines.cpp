// Blanks are spaces, tabs and what else moves the cursor within a line.
#include "lines.h"

#include <algorithm>
#include <cctype>

#include "model.h"

namespace crescent::importer {

namespace {

constexpr std::string_view blanks = " \t\v\f";

}  // namespace

std::string joined_lines(std::string_view text, bool backslash_continues) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string out;
    out.reserve(text.size() + 1);
    std::size_t begin = 0, owed = 0;  // of the line in `out`; empty lines after it
    for (std::size_t k = 0; k <= text.size(); ++k) {
        const bool is_end = k == text.size() || text[k] == '\r' || text[k] == '\n';
        if (!is_end) {
            const bool is_indent = out.size() == begin && blanks.find(text[k]) != blanks.npos;
            if (!is_indent) out += text[k];
            continue;
        }
        if (k + 1 < text.size() && text[k] == '\r' && text[k + 1] == '\n') ++k;
        if (out.size() > begin && out[begin] == '#') out.resize(begin);
        if (backslash_continues && out.size() > begin && out.back() == '\\' && k < text.size()) {
            out.back() = ' ';
            ++owed;
            continue;
        }
        out.append(owed + 1, '\n');
        owed = 0;
        begin = out.size();
    }
    return out;
}

std::optional<Statement> Statements::next() {
    while (!text_.empty()) {
        const std::size_t end = std::min(text_.find('\n'), text_.size());
        std::string_view line = text_.substr(0, end);
        text_.remove_prefix(std::min(end + 1, text_.size()));
        ++line_;
        const std::string_view key = take_word(line);
        if (!key.empty() && key[0] != '#') return Statement{line_, key, without_blanks_at_ends(line)};
    }
    return std::nullopt;
}

std::string lower_case(std::string_view word) {
    std::string out(word);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

std::string_view without_blanks_at_ends(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(blanks), text.size());
    const std::size_t end = text.find_last_not_of(blanks);
    return end == text.npos ? std::string_view() : text.substr(begin, end + 1 - begin);
}

std::string_view without_quotes(std::string_view text) {
    const bool has_quotes = text.size() > 2 && text.front() == '"' && text.back() == '"';
    return has_quotes ? text.substr(1, text.size() - 2) : text;
}

std::string_view without_comment(std::string_view text) { return text.substr(0, text.find('#')); }

std::string_view without_comment_of_name(std::string_view text) {
    for (std::size_t k = 1; k < text.size(); ++k)
        if (text[k] == '#' && blanks.find(text[k - 1]) != blanks.npos) return without_blanks_at_ends(text.substr(0, k));
    return text;
}

std::string_view take_word(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    const std::string_view word = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(word.size());
    return word;
}

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> out;
    for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) out.push_back(word);
    return out;
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
    std::vector<double> out;
    for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
        const std::optional<double> number = number_in(word);
        if (!number) return std::nullopt;
        out.push_back(*number);
    }
    return out;
}

}  // namespace crescent::importer
