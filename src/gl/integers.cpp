// Draws a full-screen triangle into an RGBA32UI framebuffer for each block and compares the result with draws(),
// integer by integer.
#include "integers.h"

#include "framebuffer.h"
#include "program.h"

namespace crescent::gl {

std::vector<std::vector<std::uint32_t>> driver_integers(
    const Context& context, const std::vector<IntegerBlock>& blocks) {
    ShaderSource source;
    source.include("integers.glsl");
    const Program program(context, source);
    const Functions& gl = context.gl();
    GLuint vertex_array = 0;
    gl.GenVertexArrays(1, &vertex_array);
    gl.BindVertexArray(vertex_array);
    gl.Disable(GL_SCISSOR_TEST);
    program.use();
    std::vector<std::vector<std::uint32_t>> out;
    for (const IntegerBlock& b : blocks) {
        const Framebuffer target(context, b.width, b.height, 1, Framebuffer::Texel::rgba32ui);
        target.bind();
        program.set("image_width", b.width);
        program.set("pair", b.pair);
        program.set("block", b.block);
        program.set("seed", b.seed);
        gl.DrawArrays(GL_TRIANGLES, 0, 3);
        target.read(0, out.emplace_back());
    }
    gl.BindVertexArray(0);
    gl.DeleteVertexArrays(1, &vertex_array);
    return out;
}

std::uint64_t unlike_integers(const IntegerBlock& b, const std::vector<std::uint32_t>& integers) {
    std::uint64_t unlike = 0;
    const std::uint32_t pixels = static_cast<std::uint32_t>(b.width) * static_cast<std::uint32_t>(b.height);
    ensure(integers.size() == std::size_t{4} * pixels, "four integers come back a pixel");
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        const Vec4u<std::uint32_t> h = draws<std::uint32_t>(pixel, b.pair, b.block, b.seed);
        const std::uint32_t* at = integers.data() + std::size_t{4} * pixel;
        unlike += (at[0] != h.x) + (at[1] != h.y) + (at[2] != h.z) + (at[3] != h.w);
    }
    return unlike;
}

}  // namespace crescent::gl
