// A sampler that is not built in: a program, or a shared library, that an experiment names instead. It draws in the
// local frame (n = +z, wo given, wi drawn), in double precision; pdf in 1/sr.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace crescent {
class Combination;

/// The data of the surface point for a sampler, in addition to wo. Files and C use the same layout.
struct ExternalSurface {
    double s;        // Phong exponent
    double alpha;    // GGX roughness
    double diffuse;  // Y(rho_d)
    double lobe;     // rho_s
};

/// A light of the scene, the same for every surface point.
struct ExternalLight {
    std::string_view kind;  // its name in LightKinds
    Rgb radiance;           // W/(sr m^2)
    double radius;  // m; of a light that is neither disk nor sphere: of a ball about its centre that contains it
};

/// A light as one surface point sees it, in the local frame of the point, m.
struct ExternalLightAt {
    Vec3<double> center;
    Vec3<double> normal;          // unit; 0 where the light has none
    Vec3<double> edge_u, edge_v;  // from the centre to the middle of an edge; 0 where it has no edges
    bool shines;                  // false: the point is on its dark side, in its plane or in it. Occlusion is ignored
};

/// Rows that follow one another at one surface point.
struct ExternalRun {
    Vec3<double> wo;
    ExternalSurface surface;
    std::size_t rows;
    Rgb rho_d{};  // by channel
};

/// A batch of draws. Row i has the `numbers` random numbers u[i * numbers ...], each in (0, 1).
struct ExternalBatch {
    std::span<const ExternalRun> runs;
    std::span<const double> u;
    std::span<const ExternalLight> lights{};       // empty if the sampler does not use them
    std::span<const ExternalLightAt> lights_at{};  // [run][light]
};

/// The output of a batch, one entry per row. pdf 0: nothing was drawn.
struct ExternalDraws {
    std::span<Vec3<double>> wi;
    std::span<double> pdf;
};

class ExternalSampler {
public:
    virtual ~ExternalSampler() = default;
    /// Returns the sampler's own name.
    virtual std::string name() const = 0;
    /// Returns the number of random numbers per sample, 1 to 8.
    virtual int numbers() const = 0;
    /// Rows of a batch at most; the default stays in the cache of a core.
    virtual std::size_t batch_rows() const { return 8192; }
    /// Whether draw() reads the lights of a batch.
    virtual bool uses_lights() const { return false; }
    /// One draw a row of u. May be called by many threads at once. Throws OutputError if it does not answer.
    virtual void draw(const ExternalBatch& batch, const ExternalDraws& out) const = 0;
    /// Returns whether it can evaluate the density of any direction.
    virtual bool has_density() const { return false; }
    /// Evaluates the density of each wi, 0 if it is never drawn; the batch has no u. Threads and exceptions as for
    /// draw().
    virtual void density(
        const ExternalBatch& /*batch*/, std::span<const Vec3<double>> /*wi*/, std::span<double> out) const {
        for (double& p : out) p = 0;
    }
    /// Whether it weights the samplers of a multiple importance sampling, by weigh(), instead of drawing.
    virtual bool has_weights() const { return false; }
    /// Writes the weight of each of K samplers for each wi, [row][K], from their densities p, [row][K]; the batch has
    /// no u. Threads and exceptions as for draw().
    virtual void weigh(const ExternalBatch& /*batch*/, std::span<const Vec3<double>> /*wi*/,
        std::span<const double> /*p*/, std::span<double> /*out*/) const {}
    /// Returns itself if it is a combination of samplers (render/combination.h), else null.
    virtual const Combination* as_combination() const { return nullptr; }
};

/// The external samplers of an experiment's arms, by arm.
using ExternalSamplers = std::map<std::string, std::shared_ptr<const ExternalSampler>, std::less<>>;
/// Returns null if the arm is built in.
inline const ExternalSampler* external_of(const ExternalSamplers& samplers, std::string_view arm) {
    const auto found = samplers.find(arm);
    return found == samplers.end() ? nullptr : found->second.get();
}

/// A sampler as the kernels take it: a name of the list in all.h, or an external sampler, which takes precedence.
struct SamplerRef {
    std::string_view sampler;
    const ExternalSampler* outside = nullptr;
    SamplerRef(std::string_view word, const ExternalSampler* from = nullptr) : sampler(word), outside(from) {}
    SamplerRef(const std::string& word) : sampler(word) {}
    SamplerRef(const char* word) : sampler(word) {}
};

// ---- The description of the surface point for a program behind a pipe: columns after w_o and u, or after w_o and
// w_i. docs/samplers.md has their order and units.

/// The quantities that a handshake may name in `uses`: "s, alpha, rho_d, rho_s, side, eta, lights".
std::span<const std::string_view> context_names();

/// Number of columns of one row for a scene with this many lights.
std::size_t context_columns(std::span<const std::string> uses, std::size_t lights);

/// Appends the columns of one surface point, in the order of `uses`. `seen`: each light relative to the point.
void add_context(std::span<const std::string> uses, const ExternalRun& point, std::span<const ExternalLight> lights,
    std::span<const ExternalLightAt> seen, std::vector<double>& to);

/// Reads names of context_names() separated by commas, each at most once; returns false for any other text.
bool take_context_names(std::string_view text, std::vector<std::string>& out);

/// The light of a check.
struct ExampleLight {
    ExternalLight light;
    ExternalLightAt at;
};
ExampleLight example_light();

/// The columns of the surface on which `crescent check` tests a sampler: the default of a plugin, below one disk light.
std::vector<double> example_context(std::span<const std::string> uses);

}  // namespace crescent
