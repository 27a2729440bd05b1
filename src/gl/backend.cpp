// Registers "gl" before main. Assertions about the context and a 1280x720 framebuffer are tested when it is opened,
// those about the film's framebuffer and three blocks of random integers before the first film; films then come from
// Estimator.
#include <fmt/format.h>

#include "backend.h"
#include "framebuffer.h"
#include "program.h"
#include "pass.h"

namespace crescent::gl {

namespace {

AssertionResult claim(
    const std::string& name, double measured, const char* op, double bound, const std::string& quantity) {
    const bool pass = std::string_view(op) == "==" ? measured == bound : measured >= bound;
    return {name, pass, measured, bound, op, fmt::format("{} {} {}", quantity, op, bound)};
}

/// Returns the share of random integers that differ from the CPU's, over some blocks of both dimensions.
double unlike_integers_here(const Context& context, std::uint32_t seed) {
    const std::vector<IntegerBlock> blocks = {
        {256, 64, 0, 0, seed}, {256, 64, 1, 1, seed}, {256, 64, 0x7fffffffu, 0, ~seed}};
    const auto integers = driver_integers(context, blocks);
    std::uint64_t unlike = 0;
    for (std::size_t k = 0; k < blocks.size(); ++k) unlike += unlike_integers(blocks[k], integers[k]);
    return static_cast<double>(unlike);
}

class GlKind : public BackendKind {
public:
    std::string name() const override { return "gl"; }
    std::shared_ptr<Backend> open(const BackendChoice& choice) const override {
        return std::make_shared<GlBackend>(open_context(choice));
    }
    std::vector<BackendDevice> devices() const override { return egl_devices(); }
};

const bool registered = [] {
    backend_kinds().push_back(std::make_shared<GlKind>());
    return true;
}();

}  // namespace

GlBackend::GlBackend(std::unique_ptr<Context> context) : context_(std::move(context)), estimator_(*context_) {
    claims_.push_back(
        claim("the GL context is core 3.3 or later", context_->version_number(), ">=", 3.3, "GL_VERSION"));
    claim_framebuffer("composite", 1280, 720, 1);
}

std::string GlBackend::name() const {
    return fmt::format("GL {}, {}, {}", context_->version(), context_->renderer(), context_->kind());
}

std::vector<std::pair<std::string, std::string>> GlBackend::details() const {
    return {{"GL_VERSION", context_->version()}, {"GL_RENDERER", context_->renderer()}, {"context", context_->kind()}};
}

void GlBackend::claim_framebuffer(const std::string& what, int width, int height, std::size_t attachments) {
    const Framebuffer target(*context_, width, height, attachments);  // throws if it is not complete
    const std::string name = fmt::format("the {} framebuffer {}x{}", what, width, height);
    claims_.push_back(claim(name + " is complete RGBA32F", target.bits(), "==", 32, "bits a channel"));
    claims_.push_back(claim(name + " has GL_FRAMEBUFFER_SRGB off", target.srgb(), "==", 0, "GL_FRAMEBUFFER_SRGB"));
    claims_.push_back(claim(name + " has no MSAA", target.multisamples(), "==", 0, "GL_SAMPLES"));
}

void GlBackend::check(const Experiment& experiment) const {
    const auto refuse = [](const SourceLocation& at, const char* what) {
        throw InputError(at, fmt::format("the GL back end has no {}: expected --instrument cpu", what));
    };
    if (!experiment.meshes.empty()) refuse(experiment.meshes.front().at, "meshes");
    if (experiment.sky) refuse(experiment.sky->at, "image skies");
}

std::vector<Film> GlBackend::films(const TiledScene& view, const Job& job, ProgressMonitor& monitor) {
    const Scene& scene = view.scene();
    ensure(!scene.surroundings(), "meshes and skies are refused before");
    if (!context_->is_current()) context_->make_current();
    if (!claimed_film_) {
        const Image& image = scene.image();
        const TileBox first =
            rectangles_of(image.width, image.height, count_lights(scene), estimator_.largest_texture()).front();
        claim_framebuffer("film", first.x1 - first.x0, first.y1 - first.y0, attachments_for(count_lights(scene).all()));
        claims_.push_back(claim("the random integers are the CPU's", unlike_integers_here(*context_, job.seed), "==", 0,
            "integers that differ"));
        claimed_film_ = true;
    }
    if (job.outside)
        throw OutputError(
            "the GL back end has no copy of the arm '" + job.arm + "', which is not built in: use the cpu");
    return estimator_.films(scene, job.sampler, job.n, job.seed, monitor);
}

// ---- Draws a full-screen triangle into an RGBA32UI framebuffer for each block and compares the result with draws(),
// integer by integer.

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
