// The file of the sampler that is checked, and the line of its function that draws: where a code host shows a verdict.
#include "sampler_place.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "crescent/crescent.h"
#include "sampler_flags.h"

namespace crescent::cli {

namespace {

/// Returns the line of the first match of a pattern from a line on; 0: there is none.
unsigned line_with(const std::vector<std::string>& lines, const std::string& pattern, unsigned from = 1) {
    const std::regex expression(pattern);
    for (unsigned k = from; k <= lines.size(); ++k)
        if (std::regex_search(lines[k - 1], expression)) return k;
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

/// Replaces the comments of a shader by blanks, so that no function is found in them.
void blank_comments(std::vector<std::string>& lines) {
    bool in_block = false;
    for (std::string& line : lines)
        for (std::size_t i = 0; i < line.size(); ++i) {
            const std::string_view pair = std::string_view(line).substr(i, 2);
            if (!in_block && pair == "//") {
                line.resize(i);
                break;
            }
            if (pair == (in_block ? "*/" : "/*")) {
                in_block = !in_block;
                line[i] = line[i + 1] = ' ';
                ++i;
            } else if (in_block) line[i] = ' ';
        }
}

/// Whether the text from this line and column on has a body before its first semicolon.
bool is_definition(const std::vector<std::string>& lines, std::size_t k, std::size_t column) {
    for (; k < lines.size(); ++k, column = 0)
        if (const std::size_t position = lines[k].find_first_of("{;", column); position != std::string::npos)
            return lines[k][position] == '{';
    return false;
}

/// The line of the definition of a function, else of its declaration; 0: there is none. A type on the line before is
/// allowed.
unsigned line_of_function(const std::vector<std::string>& lines, const std::string& name) {
    const std::regex head(R"(^\s*(?!return\b|else\b)((fn|func)\s+|([A-Za-z_][\w<>:,\[\]]*\s+)+|(?=)" + name +
        R"(\b)))" + name + R"(\s*\()");
    const std::regex type(R"(^\s*[A-Za-z_][\w<>:,\[\]]*(\s+[\w<>:,\[\]]+)*\s*$)");
    unsigned declaration = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        std::smatch match;
        if (!std::regex_search(lines[k], match, head)) continue;
        const bool is_bare = match[1].length() == 0;
        if (is_bare && (k == 0 || !std::regex_match(lines[k - 1], type))) continue;
        const auto line = static_cast<unsigned>(is_bare ? k : k + 1);
        if (is_definition(lines, k, static_cast<std::size_t>(match.length()))) return line;
        if (declaration == 0) declaration = line;
    }
    return declaration;
}

/// The statements of `// crescent: sample = ...` in a shader.
std::string sample_comments(const std::vector<std::string>& lines) {
    const std::regex comment(R"(^\s*//\s*crescent:\s*sample\s*=(.*)$)");
    std::string out;
    for (const std::string& line : lines)
        if (std::smatch match; std::regex_match(line, match, comment)) out += match[1].str() + "\n";
    return out;
}

/// The line that begins the definition of the first function that the statements call and the file defines.
/// `flag_statements`: the statements of the command line; "": those in the file.
unsigned line_in_shader(const std::string& file, const std::string& flag_statements) {
    std::vector<std::string> lines = lines_of(file);
    const std::string statements = flag_statements.empty() ? sample_comments(lines) : flag_statements;
    blank_comments(lines);
    const std::regex call(R"(([A-Za-z_][A-Za-z0-9_]*)\s*\()");
    for (std::sregex_iterator it(statements.begin(), statements.end(), call), end; it != end; ++it)
        if (const unsigned line = line_of_function(lines, (*it)[1].str())) return line;
    return 0;
}

using Place = std::pair<std::string, unsigned>;

/// FILE.py:NAME or FILE.py; none of a module.
Place place_in_python(const std::string& sampler) {
    const std::string file(python_file(sampler));
    if (file.empty()) return {};
    return {file, line_in_python(file, sampler.substr(std::min(sampler.size(), file.size() + 1)))};
}

/// The file that a command runs: its first word that is a Python script, else the first one that is a file and no
/// absolute path, which is an interpreter.
Place place_in_command(const std::string& command) {
    std::istringstream words(command);
    std::string program;
    for (std::string word; words >> word;) {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(word, ignored)) continue;
        if (word.ends_with(".py")) return {word, line_in_python(word, "sample")};
        if (program.empty() && !word.starts_with('/')) program = word;
    }
    return {program, 0};
}

/// The function that an arm of an experiment draws with, else the line of the arm; of a built-in sampler, the file.
Place place_in_experiment(const CheckFlags& flags) {
    const Experiment experiment = load(flags.arm, flags.settings);
    for (const ArmPlan& arm : experiment.arms) {
        if (arm.name != flags.sampler) continue;
        const Place place = arm.python ? place_in_python(*arm.python)
            : arm.exec                 ? place_in_command(*arm.exec)
                                       : Place{};
        if (place.second > 0) return place;
        return {flags.arm, arm.location.file == flags.arm ? arm.location.line : 0};
    }
    return {flags.arm, 0};
}

Place place_as_given(const CheckFlags& flags) {
    if (const SamplerFlag* flag = given_flag(flags); flag && flag->is_file) return {flags.sampler_of(flag->name), 0};
    if (!flags.samples.empty()) return {flags.samples, 0};
    if (!flags.exec().empty()) return place_in_command(flags.exec());
    if (names_python_sampler(flags.arm)) return place_in_python(flags.arm);
    if (names_shader(flags.arm)) {
        const auto sample = flags.shader.find("--sample");
        std::string statements;
        if (sample != flags.shader.end())
            for (const std::string& text : sample->second) statements += text + "\n";
        return {flags.arm, line_in_shader(flags.arm, statements)};
    }
    if (flags.arm.ends_with(".toml")) return place_in_experiment(flags);
    return {};
}

}  // namespace

std::pair<std::string, unsigned> place_of_sampler(const CheckFlags& flags) {
    const auto [file, line] = place_as_given(flags);
    return {std::filesystem::path(file).lexically_normal().string(), line};  // code hosts know no "./"
}

}  // namespace crescent::cli
