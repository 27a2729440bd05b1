// A linked GLSL program; the driver's message for a shader that does not compile becomes the error's text.
#pragma once

#include <array>
#include <span>
#include <string>

#include "context.h"
#include "shader_source.h"

namespace crescent::gl {

class Program {
public:
    /// Throws OutputError with the driver's log.
    Program(const Context& context, const ShaderSource& fragment);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void use() const;
    // Uniforms of the program in use; names that the compiler found unused are ignored.
    void set(const char* name, int value) const { gl().Uniform1i(at(name), value); }
    void set(const char* name, std::uint32_t value) const { gl().Uniform1ui(at(name), value); }
    void set(const char* name, int x, int y) const { gl().Uniform2i(at(name), x, y); }
    void set(const char* name, std::span<const std::array<float, 3>> all) const;
    void set(const char* name, std::span<const std::array<float, 4>> all) const;

private:
    const Functions& gl() const { return context_.gl(); }
    GLint at(const char* name) const { return gl().GetUniformLocation(program_, name); }
    GLuint compile(GLenum stage, const std::string& text, const std::string& key) const;

    const Context& context_;
    GLuint program_ = 0;
};

}  // namespace crescent::gl
