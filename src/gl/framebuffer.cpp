// Textures are created and attached, then GL is queried for the result: status, bits and type of each attachment,
// colour encoding, GL_SAMPLES. Reading is glReadPixels() of the whole, four channels per texel.
#include "framebuffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace crescent::gl {

Framebuffer::Framebuffer(const Context& context, int width, int height, std::size_t attachments, Texel texel)
    : context_(context), width_(width), height_(height), texel_(texel), textures_(attachments) {
    GLint most = 0;
    gl().GetIntegerv(GL_MAX_DRAW_BUFFERS, &most);
    if (attachments > static_cast<std::size_t>(most))
        throw OutputError(fmt::format("the GL driver draws to {} buffers at most; {} are needed", most, attachments));
    gl().GenFramebuffers(1, &framebuffer_);
    gl().GenTextures(static_cast<GLsizei>(attachments), textures_.data());
    gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    std::vector<GLenum> targets;
    for (std::size_t k = 0; k < attachments; ++k) {
        gl().BindTexture(GL_TEXTURE_2D, textures_[k]);
        if (texel == Texel::rgba32f)
            gl().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
        else
            gl().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, width, height, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, nullptr);
        context_.check("making the textures of a framebuffer");
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            gl().TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
        targets.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(k));
        gl().FramebufferTexture(GL_FRAMEBUFFER, targets.back(), textures_[k], 0);
    }
    gl().DrawBuffers(static_cast<GLsizei>(attachments), targets.data());
    gl().Disable(GL_FRAMEBUFFER_SRGB);
    context_.check("making a framebuffer");
    check();
}

Framebuffer::~Framebuffer() {
    gl().DeleteFramebuffers(1, &framebuffer_);
    gl().DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
}

void Framebuffer::check() const {
    const std::string what = fmt::format("framebuffer {}x{} RGBA32{} on {}", width_, height_,
        texel_ == Texel::rgba32f ? "F" : "UI", context_.renderer());
    if (const GLenum status = gl().CheckFramebufferStatus(GL_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE)
        throw OutputError(fmt::format("the {} is not complete (status 0x{:x}){}", what, status, context_.log().text()));
    if (bits() != 32) throw OutputError(fmt::format("the {} has {} bits a channel", what, bits()));
    const GLint type = texel_ == Texel::rgba32f ? GL_FLOAT : GL_UNSIGNED_INT;
    for (std::size_t k = 0; k < textures_.size(); ++k)
        if (of_attachment(k, GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) != type)
            throw OutputError("the " + what + " is kept as another type of number");
    if (srgb()) throw OutputError("the " + what + " is encoded as sRGB");
    if (multisamples() != 0) throw OutputError("the " + what + " is multisampled");
}

GLint Framebuffer::of_attachment(std::size_t k, GLenum what) const {
    GLint value = 0;
    gl().GetFramebufferAttachmentParameteriv(
        GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(k), what, &value);
    return value;
}

int Framebuffer::bits() const {
    GLint least = 32;
    for (std::size_t k = 0; k < textures_.size(); ++k)
        for (const GLenum size : {GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
                 GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE, GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE})
            least = std::min(least, of_attachment(k, size));
    return least;
}

bool Framebuffer::srgb() const {
    bool encoded = gl().IsEnabled(GL_FRAMEBUFFER_SRGB) == GL_TRUE;
    for (std::size_t k = 0; k < textures_.size(); ++k)
        encoded = encoded || of_attachment(k, GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING) == GL_SRGB;
    return encoded;
}

int Framebuffer::multisamples() const {
    GLint samples = 0;
    gl().GetIntegerv(GL_SAMPLES, &samples);
    return samples;
}

void Framebuffer::bind() const {
    gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl().Viewport(0, 0, width_, height_);
}

void Framebuffer::read(std::size_t attachment, std::vector<float>& rgba) const {
    rgba.resize(4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    gl().ReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachment));
    gl().ReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, rgba.data());
    context_.check("reading a framebuffer");
}

void Framebuffer::read(std::size_t attachment, std::vector<std::uint32_t>& rgba) const {
    rgba.resize(4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    gl().ReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachment));
    gl().ReadPixels(0, 0, width_, height_, GL_RGBA_INTEGER, GL_UNSIGNED_INT, rgba.data());
    context_.check("reading a framebuffer");
}

}  // namespace crescent::gl
