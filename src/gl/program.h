// A linked GLSL program; the driver's message for a shader that does not compile becomes the error's text.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "context.h"

namespace crescent::gl {

// ---- GLSL from src/gl/shaders/, embedded in the program when it is built: a file with everything it includes, each
// file once.

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

class Program {
public:
    /// Throws OutputError with the driver's log.
    Program(const Context& context, const ShaderSource& fragment);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void use() const;
    // Uniforms of the program in use; names that the compiler found unused are ignored.
    void set(const char* name, int value) const { gl().Uniform1i(location_of(name), value); }
    void set(const char* name, std::uint32_t value) const { gl().Uniform1ui(location_of(name), value); }
    void set(const char* name, int x, int y) const { gl().Uniform2i(location_of(name), x, y); }
    void set(const char* name, std::span<const std::array<float, 3>> values) const;
    void set(const char* name, std::span<const std::array<float, 4>> values) const;

private:
    const Functions& gl() const { return context_.gl(); }
    GLint location_of(const char* name) const { return gl().GetUniformLocation(program_, name); }
    GLuint compile(GLenum stage, const std::string& text, const std::string& key) const;

    const Context& context_;
    GLuint program_ = 0;
};

}  // namespace crescent::gl
