// A draw takes what the pacer's budget allows over the fullest strip of rows, in blocks of 16 samples up to 4096, and
// is timed to its end. Sums are added in double, the spread of X by Chan, Golub & LeVeque 1983. For every further 12
// lights the samples are drawn again.
#include "pass.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

namespace crescent::gl {

// ---- Textures are created and attached, then GL is queried for the result: status, bits and type of each attachment,
// colour encoding, GL_SAMPLES. Reading is glReadPixels() of the whole, four channels per texel.

Framebuffer::Framebuffer(const Context& context, int width, int height, std::size_t attachments, Texel texel)
    : context_(context), width_(width), height_(height), texel_(texel), textures_(attachments) {
    GLint limit = 0;
    gl().GetIntegerv(GL_MAX_DRAW_BUFFERS, &limit);
    if (attachments > static_cast<std::size_t>(limit))
        throw OutputError(fmt::format("the GL driver draws to {} buffers at most; {} are needed", limit, attachments));
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
    GLint bit_count = 32;
    for (std::size_t k = 0; k < textures_.size(); ++k)
        for (const GLenum size : {GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
                 GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE, GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE})
            bit_count = std::min(bit_count, of_attachment(k, size));
    return bit_count;
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

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t longest_sum = 4096;  // samples in a draw's float sums at most, see estimator.glsl

}  // namespace

Pass::Pass(const Context& context, const PointTexture& shading_points, const Framebuffer& framebuffer,
    std::vector<LobePart> parts, std::size_t lights, ProgressMonitor& monitor)
    : context_(context),
      shading_points_(shading_points),
      framebuffer_(framebuffer),
      parts_(std::move(parts)),
      lights_(lights),
      monitor_(monitor),
      moments_(shading_points.groups().size()),
      light_sums_(framebuffer.attachments() - 2) {
    for (std::size_t g = 0; g < moments_.size(); ++g) {
        moments_[g].resize(shading_points.groups()[g]);
        means_.emplace_back(shading_points.groups()[g].count);
    }
}

void Pass::advance_to(std::uint64_t n) {
    while (sample_count_ < n) {
        const int samples = samples_per_draw(n - sample_count_);
        take(samples);
        sample_count_ += static_cast<std::uint64_t>(samples);
    }
}

/// As many as a draw over the fullest strip can take, in whole blocks of 16, which gives few large draws and readings.
int Pass::samples_per_draw(std::uint64_t remainder) const {
    std::uint64_t fits = longest_sum;
    for (const LobePart& part : parts_) {
        const std::uint64_t fullest = *std::max_element(part.pixels.strips.begin(), part.pixels.strips.end());
        fits = std::min(fits, std::max<std::uint64_t>(part.pacer->budget() / fullest / 16 * 16, 16));
    }
    return static_cast<int>(std::min(fits, remainder));
}

void Pass::take(int samples) {
    for (std::size_t first = 0; first == 0 || first < lights_; first += most_recorded) {
        for (LobePart& part : parts_) {
            part.program->use();
            if (part.pacer->untried()) warm_up(part);
            part.program->set("first_sample", static_cast<int>(sample_count_));
            part.program->set("samples", samples);
            part.program->set("first_recorded", static_cast<int>(first));
            draw_part(part, samples);
        }
        gather(first, samples);
    }
}

/// A draw of no samples: drivers finish compiling at a program's first draw, which must not count as its speed.
void Pass::warm_up(const LobePart& part) {
    part.program->set("samples", 0);
    draw_strips(part, 0, 1);
}

void Pass::draw_part(LobePart& part, int samples) {
    const std::vector<std::uint64_t>& strips = part.pixels.strips;
    const std::uint64_t each = static_cast<std::uint64_t>(samples);
    for (std::size_t k = 0; k < strips.size();) {
        const std::size_t from = k;
        std::uint64_t pixels = strips[k++];
        while (k < strips.size() && (pixels + strips[k]) * each <= part.pacer->budget()) pixels += strips[k++];
        if (pixels == 0) continue;
        const auto start = Clock::now();
        draw_strips(part, from, k);
        part.pacer->took(pixels * each, std::chrono::duration<double>(Clock::now() - start).count());
        monitor_.advance(static_cast<double>(pixels * each) / static_cast<double>(passes()));
        monitor_.check();
    }
}

void Pass::draw_strips(const LobePart& part, std::size_t from, std::size_t to) {
    const Functions& gl = context_.gl();
    const int y0 = static_cast<int>(from) * strip_rows,
              y1 = std::min(static_cast<int>(to) * strip_rows, shading_points_.height());
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(part.pixels.x0, y0, part.pixels.x1 - part.pixels.x0, y1 - y0);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.Finish();
    context_.check("a draw");
}

/// Adds the results of the last draws of all parts.
void Pass::gather(std::size_t first_light, int samples) {
    const double old_count = static_cast<double>(sample_count_), new_count = samples;
    if (first_light == 0) {
        framebuffer_.read(0, sums_);
        framebuffer_.read(1, counts_);
    }
    for (std::size_t k = 0; k < light_sums_.size(); ++k) framebuffer_.read(2 + k, light_sums_[k]);
    const std::size_t lights = std::min(lights_ - std::min(first_light, lights_), most_recorded);
    tbb::parallel_for(std::size_t{0}, moments_.size(), [&](std::size_t g) {
        const ShadingPoints& group = shading_points_.groups()[g];
        Moments& m = moments_[g];
        for (std::size_t i = 0; i < group.count; ++i) {
            const std::size_t offset = 4 * shading_points_.texel(group, i);
            if (first_light == 0) {
                m.g[i] += static_cast<double>(sums_[offset]);
                m.g_lobe[i] += static_cast<double>(sums_[offset + 1]);
                const double delta =
                    static_cast<double>(counts_[offset + 3]) - means_[g][i];  // Chan, Golub & LeVeque 1983
                m.spread[i] += static_cast<double>(sums_[offset + 2]) +
                    delta * delta * (old_count * new_count / (old_count + new_count));
                means_[g][i] += delta * (new_count / (old_count + new_count));
                m.largest[i] = std::max(m.largest[i], sums_[offset + 3]);
                m.horizon[i] += static_cast<std::uint32_t>(counts_[offset]);
                m.hits[i] += static_cast<std::uint32_t>(counts_[offset + 1]);
                m.bad[i] += static_cast<std::uint32_t>(counts_[offset + 2]);
            }
            for (std::size_t k = 0; k < lights; ++k) {
                const float* pair = light_sums_[k / 2].data() + offset + 2 * (k % 2);
                m.light_g[first_light + k][i] += static_cast<double>(pair[0]);
                m.light_g_lobe[first_light + k][i] += static_cast<double>(pair[1]);
            }
        }
    });
}

}  // namespace crescent::gl
