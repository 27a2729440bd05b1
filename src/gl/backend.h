// The GL back end: computes the same films as the CPU, in GLSL.
#pragma once

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

}  // namespace crescent::gl
