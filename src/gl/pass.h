// One rectangle of a film: draws of bounded length and their moments, a sample count whenever its samples are complete.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "context.h"
#include "point_texture.h"
#include "program.h"

namespace crescent::gl {

// ---- A framebuffer of 32-bit float textures, checked: complete, every channel a 32-bit float, no sRGB, no
// multisampling. Fewer bits are an error; there is no fallback.

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

// ---- Limits the work of one draw. Drivers end a draw that takes too long, and none can be interrupted: draws last
// about a tenth of a second, so that none reaches 0.2 s on llvmpipe even if the next rows cost twice as much.

class Pacer {
public:
    static constexpr double aim_s = 0.08;

    /// Returns the samples (pixels x samples per pixel) of the next draw.
    std::uint64_t budget() const { return std::max<std::uint64_t>(budget_, smallest_budget); }
    /// Records the duration of a draw of `work` samples. The budget grows at most fourfold per draw and shrinks at
    /// once.
    void took(std::uint64_t work, double seconds) {
        longest_ = std::max(longest_, seconds);
        if (work == 0) return;
        const double fits = static_cast<double>(work) * aim_s / std::max(seconds, 1e-6);
        budget_ = static_cast<std::uint64_t>(std::min(fits, 4.0 * static_cast<double>(budget())));
    }
    double longest_s() const { return longest_; }
    bool untried() const { return longest_ == 0; }

private:
    static constexpr std::uint64_t smallest_budget = 16384;
    std::uint64_t budget_ = smallest_budget;
    double longest_ = 0;
};

/// Lights whose sums one draw can write in addition to its two fixed attachments: core 3.3 guarantees 8 draw buffers.
constexpr std::size_t most_recorded = 12;
constexpr std::size_t recorded_lights(std::size_t lights) { return lights < most_recorded ? lights : most_recorded; }
constexpr std::size_t attachments_for(std::size_t lights) { return 2 + (recorded_lights(lights) + 1) / 2; }

/// The pixels of one lobe in the rectangle, and the program that draws them.
struct LobePart {
    Program* program = nullptr;
    Pacer* pacer = nullptr;
    LobePixels pixels;
};

class Pass {
public:
    Pass(const Context& context, const PointTexture& shading_points, const Framebuffer& framebuffer,
        std::vector<LobePart> parts, std::size_t lights, ProgressMonitor& monitor);

    /// Takes samples [done, n); after that, moments() are those of n samples.
    void advance_to(std::uint64_t n);
    const std::vector<Moments>& moments() const { return moments_; }

private:
    /// Returns how often each sample is drawn, so that every light has its sums.
    std::size_t passes() const { return lights_ == 0 ? 1 : (lights_ + most_recorded - 1) / most_recorded; }
    int samples_per_draw(std::uint64_t remainder) const;
    void take(int samples);
    void draw_part(LobePart& part, int samples);
    void draw_strips(const LobePart& part, std::size_t from, std::size_t to);
    void warm_up(const LobePart& part);
    void gather(std::size_t first_light, int samples);

    const Context& context_;
    const PointTexture& shading_points_;
    const Framebuffer& framebuffer_;
    std::vector<LobePart> parts_;
    std::size_t lights_;
    ProgressMonitor& monitor_;
    std::uint64_t sample_count_ = 0;
    std::vector<Moments> moments_;            // one per group of shading points
    std::vector<std::vector<double>> means_;  // of X so far, like moments_
    std::vector<float> sums_, counts_;
    std::vector<std::vector<float>> light_sums_;
};

}  // namespace crescent::gl
