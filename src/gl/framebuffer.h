// A framebuffer of 32-bit float textures, checked: complete, every channel a 32-bit float, no sRGB, no multisampling.
// Fewer bits are an error; there is no fallback.
#pragma once

#include <string>
#include <vector>

#include "context.h"

namespace crescent::gl {

class Framebuffer {
public:
    enum class Texel { rgba32f, rgba32ui };

    /// Throws OutputError if the driver does not provide what is requested.
    Framebuffer(const Context& context, int width, int height, std::size_t attachments, Texel texel = Texel::rgba32f);
    ~Framebuffer();
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t attachments() const { return textures_.size(); }
    /// Makes it the target of draws, over its whole size.
    void bind() const;
    /// Reads every texel of an attachment, rows bottom-up.
    void read(std::size_t attachment, std::vector<float>& rgba) const;
    void read(std::size_t attachment, std::vector<std::uint32_t>& rgba) const;

    /// Returns the smallest number of bits of any channel of any attachment.
    int bits() const;
    bool srgb() const;  // GL_FRAMEBUFFER_SRGB or an sRGB-encoded attachment
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
