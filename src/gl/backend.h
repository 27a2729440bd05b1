// The GL back end: computes the same films as the CPU, in GLSL.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator.h"

namespace crescent::gl {

class GlBackend : public Backend {
public:
    /// Makes the context current on this thread.
    explicit GlBackend(std::unique_ptr<Context> context);

    std::string name() const override;
    std::vector<std::pair<std::string, std::string>> details() const override;
    void check(const Experiment& experiment) const override;
    std::vector<Film> films(const TiledScene& view, const Job& job, ProgressMonitor& monitor) override;
    std::vector<AssertionResult> assertions() const override { return claims_; }

    Context& context() { return *context_; }
    const Estimator& estimator() const { return estimator_; }

private:
    void claim_framebuffer(const std::string& what, int width, int height, std::size_t attachments);

    std::unique_ptr<Context> context_;
    Estimator estimator_;
    std::vector<AssertionResult> claims_;
    bool claimed_film_ = false;
};

// ---- The random integers as the driver computes them.

/// The input of a set of hashes: pixels 0 to width x height - 1, one pair of samples, one block of dimensions, one
/// seed.
struct IntegerBlock {
    int width = 0, height = 0;
    std::uint32_t pair = 0, block = 0, seed = 0;
};

/// Returns four integers per pixel, by src/gl/shaders/integers.glsl, for each block.
std::vector<std::vector<std::uint32_t>> driver_integers(
    const Context& context, const std::vector<IntegerBlock>& blocks);
/// Returns how many of them differ from draws() of src/math/simd/random.h.
std::uint64_t unlike_integers(const IntegerBlock& block, const std::vector<std::uint32_t>& integers);

}  // namespace crescent::gl
