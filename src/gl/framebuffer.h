// A framebuffer of 32-bit float textures, checked: complete, every channel a 32-bit float, no sRGB, no multisampling.
// One that a driver makes of fewer bits is an error, never a fallback.
#pragma once

#include <string>
#include <vector>

#include "context.h"

namespace crescent::gl {

class Framebuffer {
public:
    enum class Texel { rgba32f, rgba32ui };

    /// Throws OutputError where the driver does not give what is asked for.
    Framebuffer(const Context& context, int width, int height, std::size_t attachments, Texel texel = Texel::rgba32f);
    ~Framebuffer();
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t attachments() const { return textures_.size(); }
    /// Draws go here from now on, to the whole of it.
    void bind() const;
    /// Every texel of an attachment, rows bottom-up.
    void read(std::size_t attachment, std::vector<float>& rgba) const;
    void read(std::size_t attachment, std::vector<std::uint32_t>& rgba) const;

    /// Smallest number of bits of any channel of any attachment.
    int bits() const;
    bool srgb() const;  // GL_FRAMEBUFFER_SRGB or an attachment encoded so
    int multisamples() const;

private:
    const Functions& gl() const { return context_.gl(); }
    GLint of_attachment(std::size_t k, GLenum what) const;
    void check() const;

    const Context& context_;
    int width_, height_;
    Texel texel_;
    GLuint framebuffer_ = 0;
    std::vector<GLuint> textures_;
};

}  // namespace crescent::gl
