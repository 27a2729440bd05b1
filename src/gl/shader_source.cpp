// Depth first: an included file goes before the text of the including file, whose #include lines become empty; #line
// starts each file's numbering at 1000 k + 1, k its index in the order of first inclusion.
#include "shader_source.h"

#include <algorithm>
#include <sstream>

#include "crescent/crescent.h"

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
    const std::size_t base = lines_per_file * paths_.size();
    paths_.push_back(path);
    std::istringstream lines(text);
    std::string own;
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view word = "#include \"";
        if (line.starts_with(word)) {
            include(line.substr(word.size(), line.rfind('"') - word.size()));
            line.clear();
        }
        own += line + "\n";
    }
    body_ += "#line " + std::to_string(base + 1) + "\n" + own;
}

std::string ShaderSource::key() const {
    std::string out = "lines";
    for (std::size_t k = 0; k < paths_.size(); ++k)
        out += (k ? ", " : " ") + std::to_string(lines_per_file * k) + " + n: " + paths_[k];
    return out;
}

std::string glsl_word(std::string name) {
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

}  // namespace crescent::gl
