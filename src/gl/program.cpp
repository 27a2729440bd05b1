// The vertex shader is always full_screen.vert.glsl. If a shader does not compile or the two do not link, the error
// contains the driver's name, version and log, and the key to the log's line numbers.
#include <algorithm>
#include <fmt/format.h>
#include <sstream>

#include "crescent/crescent.h"
#include "program.h"

namespace crescent::gl {

// ---- Depth first: an included file goes before the text of the including file, whose #include lines become empty;
// #line starts each file's numbering at 1000 k + 1, k its index in the order of first inclusion.

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
    std::string content;
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view word = "#include \"";
        if (line.starts_with(word)) {
            include(line.substr(word.size(), line.rfind('"') - word.size()));
            line.clear();
        }
        content += line + "\n";
    }
    body_ += "#line " + std::to_string(base + 1) + "\n" + content;
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

namespace {

template <class Get> std::string log_of(GLint length, Get&& get) {
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei size = 0;
    get(static_cast<GLsizei>(log.size()), &size, log.data());
    log.resize(static_cast<std::size_t>(size));
    return log.empty() ? "the driver gives no reason" : log;
}

}  // namespace

GLuint Program::compile(GLenum stage, const std::string& text, const std::string& key) const {
    const GLuint shader = gl().CreateShader(stage);
    const char* source = text.c_str();
    gl().ShaderSource(shader, 1, &source, nullptr);
    gl().CompileShader(shader);
    GLint compiled = GL_FALSE, length = 0;
    gl().GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return shader;
    gl().GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    const std::string log =
        log_of(length, [&](GLsizei n, GLsizei* size, char* to) { gl().GetShaderInfoLog(shader, n, size, to); });
    gl().DeleteShader(shader);
    context_.check("compiling a shader");
    throw OutputError(fmt::format(
        "a shader does not compile on {} ({}):\n{}\n{}", context_.renderer(), context_.version(), log, key));
}

Program::Program(const Context& context, const ShaderSource& fragment) : context_(context) {
    const std::string corners = std::string("#version 330 core\n") + shader_text("full_screen.vert.glsl");
    const GLuint first = compile(GL_VERTEX_SHADER, corners, "full_screen.vert.glsl");
    const GLuint second = compile(GL_FRAGMENT_SHADER, fragment.text(), fragment.key());
    program_ = gl().CreateProgram();
    for (const GLuint shader : {first, second}) {
        gl().AttachShader(program_, shader);
        gl().DeleteShader(shader);  // it lives as long as the program
    }
    gl().LinkProgram(program_);
    GLint linked = GL_FALSE, length = 0;
    gl().GetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return;
    gl().GetProgramiv(program_, GL_INFO_LOG_LENGTH, &length);
    const std::string log =
        log_of(length, [&](GLsizei n, GLsizei* size, char* to) { gl().GetProgramInfoLog(program_, n, size, to); });
    gl().DeleteProgram(program_);
    throw OutputError(fmt::format(
        "a shader does not link on {} ({}):\n{}\n{}", context_.renderer(), context_.version(), log, fragment.key()));
}

Program::~Program() { gl().DeleteProgram(program_); }

void Program::use() const { gl().UseProgram(program_); }

void Program::set(const char* name, std::span<const std::array<float, 3>> values) const {
    gl().Uniform3fv(location_of(name), static_cast<GLsizei>(values.size()), values.data()->data());
}
void Program::set(const char* name, std::span<const std::array<float, 4>> values) const {
    gl().Uniform4fv(location_of(name), static_cast<GLsizei>(values.size()), values.data()->data());
}

}  // namespace crescent::gl
