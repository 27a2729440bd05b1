#include "shader_source.h"

#include <algorithm>
#include <sstream>

#include "crescent.h"

namespace crescent::gl {

const char* shader_text(const std::string& path) {
    for (int k = 0; k < shader_file_count; ++k)
        if (path == shader_files[k].path) return shader_files[k].text;
    return nullptr;
}

void ShaderSource::include(const std::string& path) {
    if (std::find(paths_.begin(), paths_.end(), path) != paths_.end()) return;
    const char* text = shader_text(path);
    ensure(text, "every shader that is included is embedded");
    add(path, text);
}

void ShaderSource::add(const std::string& path, const std::string& text) {
    const std::string number = std::to_string(paths_.size());
    paths_.push_back(path);
    std::istringstream lines(text);
    std::string own;
    int line_number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++line_number;
        constexpr std::string_view word = "#include \"";
        if (line.starts_with(word)) include(line.substr(word.size(), line.rfind('"') - word.size()));
        else if (own.empty()) own = "#line " + std::to_string(line_number) + " " + number + "\n" + line + "\n";
        else own += line + "\n";
        // What follows an include has the number of its own line again.
        if (line.starts_with(word) && !own.empty()) own += "\n";
    }
    body_ += own;
}

std::string ShaderSource::key() const {
    std::string out;
    for (std::size_t k = 0; k < paths_.size(); ++k) out += (k ? ", source " : "source ") + std::to_string(k) + ": " + paths_[k];
    return out;
}

std::string glsl_word(std::string name) {
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

}  // namespace crescent::gl
