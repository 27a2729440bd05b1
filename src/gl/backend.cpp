// Registers "gl" before main. Assertions about the context and a 1280x720 framebuffer are tested when it is opened,
// those about the film's framebuffer and three blocks of random integers before the first film; films then come from
// Estimator.

#include <algorithm>
#include <fmt/format.h>

#include "backend.h"
#include "egl_context.h"
#include "pass.h"
#include "program.h"

namespace crescent::gl {

// ---- Computes the image in rectangles, one after another: its shading points, a program for each lobe there (compiled
// for the sampler, the lobe and the numbers of lights and bodies, cached by its text), then a Pass sample count by
// sample count, whose moments resolve_film() converts to radiance.

namespace {

/// "sphere" -> "SPHERE_LIGHT".
std::string light_word(std::string_view kind) {
    std::string out(kind);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::toupper(c); });
    return out + "_LIGHT";
}
std::string lobe_word(int lobe) { return glsl_word(std::string(lobe_info(static_cast<LobeKind>(lobe)).name)); }

}  // namespace

ShaderSource estimator_source(
    const std::string& sampler, int lobe, const LightCounts& lights, const std::array<std::size_t, 5>& bodies) {
    ShaderSource source;
    const std::size_t recorded = recorded_lights(lights.total());
    std::size_t body_count = 0;
    constexpr std::array<const char*, 5> kinds = {"SPHERES", "BOXES", "QUADS", "PLATES", "PLANES"};
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        source.define(kinds[k], bodies[k]);
        body_count += bodies[k];
    }
    source.define("BODY_SLOTS", std::max<std::size_t>(body_count, 1));  // GLSL has no empty arrays
    source.define("LOBE", std::to_string(lobe + 1));
    if (lobe >= 0) source.define("lobe_here", "lobe_" + lobe_word(lobe));
    source.define("DISKS", lights.disks);
    source.define("DISK_SLOTS", std::max<std::size_t>(lights.disks, 1));
    source.define("OTHERS", lights.others);
    source.define("OTHER_SLOTS", std::max<std::size_t>(lights.others, 1));
    for (std::size_t k = 1; k < LightKinds::names.size(); ++k) source.define(light_word(LightKinds::names[k]), k);
    source.define("RECORDED", recorded);
    source.define("RECORDED_SLOTS", std::max<std::size_t>((recorded + 1) / 2 * 2, 2));
    source.define("sample_arm", "sample_" + glsl_word(sampler));
    source.include("arms/" + glsl_word(sampler) + ".glsl");
    if (lobe >= 0) source.include("lobes/" + lobe_word(lobe) + ".glsl");
    source.include("estimator.glsl");
    return source;
}

Estimator::Estimator(const Context& context, int largest_texture) : context_(context) {
    const Functions& gl = context.gl();
    gl.GenVertexArrays(1, &vertex_array_);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &largest_texture_);
    if (largest_texture > 0) largest_texture_ = std::min(largest_texture_, largest_texture);
    context.check("looking at the context");
}

double Estimator::longest_draw_s() const {
    double longest = 0;
    for (const auto& [text, kernel] : kernels_) longest = std::max(longest, kernel->pacer.longest_s());
    return longest;
}

Estimator::Kernel& Estimator::kernel(
    const std::string& sampler, int lobe, const LightCounts& lights, const Bodies& bodies) {
    const ShaderSource source = estimator_source(sampler, lobe, lights, bodies.counts);
    std::unique_ptr<Kernel>& kernel = kernels_[source.text()];
    if (!kernel) kernel = std::make_unique<Kernel>(context_, source);
    return *kernel;
}

const PointTexture& Estimator::shading_points(const Scene& scene, const TileBox& box, ProgressMonitor& monitor) {
    const auto is_same_box = [](const TileBox& a, const TileBox& b) {
        return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
    };
    if (shading_points_ && points_of_->is_same_as(scene) && is_same_box(shading_points_->box(), box))
        return *shading_points_;
    shading_points_.reset();
    shading_points_.emplace(context_, scene, box, monitor);
    points_of_ = scene;
    return *shading_points_;
}

const Framebuffer& Estimator::framebuffer(int width, int height, std::size_t attachments) {
    if (!framebuffer_ || framebuffer_->width() != width || framebuffer_->height() != height ||
        framebuffer_->attachments() != attachments) {
        framebuffer_.reset();
        framebuffer_.emplace(context_, width, height, attachments);
    }
    return *framebuffer_;
}

namespace {

/// The inputs of every draw of a program except the samples' range.
void set_scene(const Program& program, const ShadingPoints& lights, const Bodies& bodies, const TileBox& box,
    int image_width, std::uint32_t seed) {
    program.use();
    program.set("shading_points", 0);
    program.set("corner", box.x0, box.y0);
    program.set("image_width", image_width);
    program.set("seed", seed);
    std::vector<std::array<float, 3>> disks;
    for (const DiskArrays& d : lights.disks) disks.push_back({d.radius, d.two_sided ? 1.0f : 0.0f, d.power});
    if (!disks.empty()) program.set("disk_kind", disks);
    if (!bodies.vectors.empty()) program.set("bodies", bodies.vectors);
}

}  // namespace

void Estimator::estimate(const Scene& scene, const TileBox& box, const std::string& sampler, std::uint32_t seed,
    std::vector<Film>& films, ProgressMonitor& monitor) {
    const LightCounts counts = count_lights(scene);
    const PointTexture& points = shading_points(scene, box, monitor);
    if (points.groups().empty()) return;
    const ShadingPoints lights = empty_points(scene, -1);  // a group's own occluders are those that can affect it
    const Bodies bodies = bodies_of(lights.occluders);
    std::vector<LobePart> parts;
    for (const int lobe : points.lobes()) {
        if (lobe >= 0 && !shader_text("lobes/" + lobe_word(lobe) + ".glsl"))
            throw OutputError("the GL back end has no copy of the lobe '" +
                std::string(lobe_info(static_cast<LobeKind>(lobe)).name) + "': use the cpu");
        Kernel& k = kernel(sampler, lobe, counts, bodies);
        set_scene(k.program, lights, bodies, box, scene.image().width, seed);
        parts.push_back({&k.program, &k.pacer, points.pixels_of(lobe)});
    }
    const Framebuffer& target = framebuffer(points.width(), points.height(), attachments_for(counts.total()));
    context_.gl().BindVertexArray(vertex_array_);  // core profiles draw nothing without one
    points.bind();
    target.bind();
    Pass pass(context_, points, target, std::move(parts), counts.total(), monitor);
    for (Film& film : films) {
        pass.advance_to(film.n);
        for (std::size_t g = 0; g < points.groups().size(); ++g) {
            resolve_film(scene, points.groups()[g], pass.moments()[g], film);
            for (const std::uint32_t bad : pass.moments()[g].bad) film.invalid += bad;
        }
    }
}

std::vector<Film> Estimator::films(const Scene& scene, const std::string& sampler, const std::vector<std::uint64_t>& n,
    std::uint32_t seed, ProgressMonitor& monitor) {
    ensure(arm_index(sampler) >= 0, "the parser lets only known samplers through");
    if (!(find_arm_info(sampler)->gl.relative > 0))
        throw OutputError("the GL back end has no copy of the sampler '" + sampler + "': use the cpu");
    for (const Light& light : scene.lights())
        if (std::string(shader_text("lights.glsl")).find(light_word(light.kind())) == std::string::npos &&
            !light.is_disk())
            throw OutputError(fmt::format(
                "the GL back end has no light of the kind '{}' ({}): use the cpu", light.kind(), light.name));
    const Image& image = scene.image();
    std::vector<Film> out;
    for (const std::uint64_t sample_count : n) {
        out.emplace_back(image.width, image.height, sample_count);
        out.back().directions = out.back().evaluations = directions_per_sample(sampler);
    }
    for (const TileBox& box : rectangles_of(image.width, image.height, count_lights(scene), largest_texture_))
        estimate(scene, box, sampler, seed, out, monitor);
    return out;
}

namespace {

AssertionResult claim(
    const std::string& name, double value, const char* op, double bound, const std::string& quantity) {
    const bool pass = std::string_view(op) == "==" ? value == bound : value >= bound;
    return {name, pass, value, bound, op, fmt::format("{} {} {}", quantity, op, bound)};
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
    const auto refuse = [](const SourceLocation& place, const char* what) {
        throw InputError(place, fmt::format("the GL back end has no {}: expected --instrument cpu", what));
    };
    if (!experiment.meshes.empty()) refuse(experiment.meshes.front().location, "meshes");
    if (experiment.sky) refuse(experiment.sky->location, "image skies");
}

std::vector<Film> GlBackend::films(const TiledScene& view, const Job& job, ProgressMonitor& monitor) {
    const Scene& scene = view.scene();
    ensure(!scene.surroundings(), "meshes and skies are refused before");
    if (!context_->is_current()) context_->make_current();
    if (!claimed_film_) {
        const Image& image = scene.image();
        const TileBox first =
            rectangles_of(image.width, image.height, count_lights(scene), estimator_.largest_texture()).front();
        claim_framebuffer(
            "film", first.x1 - first.x0, first.y1 - first.y0, attachments_for(count_lights(scene).total()));
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
        const std::uint32_t* components = integers.data() + std::size_t{4} * pixel;
        unlike += (components[0] != h.x) + (components[1] != h.y) + (components[2] != h.z) + (components[3] != h.w);
    }
    return unlike;
}

}  // namespace crescent::gl
