// The file of the sampler that is checked, and the line of its function that draws: where a code host shows a verdict.
#include "sampler_place.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "crescent/crescent.h"

namespace crescent::cli {

namespace {

/// Returns the line of the first match of a pattern from a line on; 0: there is none.
unsigned line_with(const std::vector<std::string>& lines, const std::string& pattern, unsigned from = 1) {
    const std::regex wanted(pattern);
    for (unsigned k = from; k <= lines.size(); ++k)
        if (std::regex_search(lines[k - 1], wanted)) return k;
    return 0;
}

std::vector<std::string> lines_of(const std::string& file) {
    std::vector<std::string> out;
    std::ifstream in(file);
    constexpr std::size_t longest = 2000;  // characters: a regular expression takes memory for each
    for (std::string line; std::getline(in, line);) out.push_back(line.substr(0, longest));
    return out;
}

bool is_name(const std::string& text) { return std::regex_match(text, std::regex("[A-Za-z_][A-Za-z0-9_]*")); }

/// The line of the function `name`, or of `sample` in the class `name` or else in the file.
unsigned line_in_python(const std::string& file, const std::string& name) {
    const std::vector<std::string> lines = lines_of(file);
    const std::string draws = R"(^\s*(async )?def sample\s*\()";
    if (is_name(name)) {
        if (const unsigned line = line_with(lines, R"(^\s*(async )?def )" + name + R"(\s*\()")) return line;
        if (const unsigned type = line_with(lines, R"(^\s*class )" + name + R"(\b)"))
            if (const unsigned line = line_with(lines, draws, type)) return line;
    }
    if (const unsigned line = line_with(lines, draws)) return line;
    return is_name(name) ? line_with(lines, R"(^)" + name + R"(\s*[=:])") : 0;
}

/// The line that begins the definition of the first function that the statements call and the file defines.
unsigned line_in_shader(const std::string& file, const std::string& statements) {
    const std::vector<std::string> lines = lines_of(file);
    const std::regex call(R"(([A-Za-z_][A-Za-z0-9_]*)\s*\()");
    for (std::sregex_iterator it(statements.begin(), statements.end(), call), end; it != end; ++it) {
        const std::string head = R"(^\s*(?!return\b|else\b)(fn\s+|([A-Za-z_][\w<>:]*\s+)+))" + (*it)[1].str();
        if (const unsigned line = line_with(lines, head + R"(\s*\()")) return line;
    }
    return 0;
}

}  // namespace

std::pair<std::string, unsigned> place_of_sampler(const CheckFlags& flags) {
    if (!flags.plugin.empty()) return {flags.plugin, 0};
    if (!flags.samples.empty()) return {flags.samples, 0};
    if (!flags.exec.empty()) {
        std::istringstream words(flags.exec);
        std::error_code ignored;
        for (std::string word; words >> word;) {
            if (word.starts_with('/') || !std::filesystem::is_regular_file(word, ignored)) continue;
            return {word, word.ends_with(".py") ? line_in_python(word, "sample") : 0};
        }
        return {};
    }
    if (names_python_sampler(flags.arm)) {
        const std::size_t colon = flags.arm.rfind(':');
        return {flags.arm.substr(0, colon), line_in_python(flags.arm.substr(0, colon), flags.arm.substr(colon + 1))};
    }
    if (names_shader(flags.arm)) {
        const auto sample = flags.shader.find("--sample");
        std::string statements;
        if (sample != flags.shader.end())
            for (const std::string& text : sample->second) statements += text + "\n";
        return {flags.arm, line_in_shader(flags.arm, statements)};
    }
    if (flags.arm.ends_with(".toml"))
        return {flags.arm,
            is_name(flags.sampler) ? line_with(lines_of(flags.arm), R"(^\s*\[+arms\."?)" + flags.sampler + R"(\b)")
                                   : 0};
    return {};
}

}  // namespace crescent::cli
