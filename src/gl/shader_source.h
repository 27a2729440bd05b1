// GLSL from src/gl/shaders/, embedded in the program when it is built: a file with everything it includes, each file
// once.
#pragma once

#include <string>
#include <vector>

namespace crescent::gl {

/// The files by their path under src/gl/shaders/, as embedded.
struct ShaderFile {
    const char *path, *text;
};
extern const ShaderFile shader_files[];
extern const int shader_file_count;

/// Returns null if there is no such path.
const char* shader_text(const std::string& path);

/// A compilation unit: #version 330, #define lines, then files. Drivers name sources differently, so each file has line
/// numbers of its own in their logs: line n of file k is 1000 k + n.
class ShaderSource {
public:
    static constexpr std::size_t lines_per_file = 1000;

    void define(const std::string& name, const std::string& value) { head_ += "#define " + name + " " + value + "\n"; }
    void define(const std::string& name, std::size_t value) { define(name, std::to_string(value)); }
    /// Adds a file after the files it includes.
    void include(const std::string& path);
    /// Adds text like a file.
    void add(const std::string& path, const std::string& text);
    std::string text() const { return "#version 330 core\n" + head_ + body_; }
    /// Returns "lines 0 + n: frame.glsl, 1000 + n: ...", the meaning of the line numbers of a log.
    std::string key() const;

private:
    std::string head_, body_;
    std::vector<std::string> paths_;
};

/// Returns "light_area" for "light-area", the name of its file and functions.
std::string glsl_word(std::string name);

}  // namespace crescent::gl
