// A sampler in a shader file, for check_sampler and the matchers of gtest.h. docs/shaders.md has the snippets and the
// options.
#pragma once

#include <concepts>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "check/sources/external.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// A constant of a shader, as --set reads it: a float, an int, a bool or a vector of 2 to 4 floats.
class ShaderValue {
public:
    ShaderValue(std::floating_point auto v) : text_(float_text(static_cast<double>(v))) {}
    ShaderValue(std::integral auto v) : text_(std::to_string(v)) {}
    ShaderValue(bool v) : text_(v ? "true" : "false") {}
    ShaderValue(std::initializer_list<double> vector);
    /// As the command line has it.
    const std::string& text() const { return text_; }

private:
    std::string text_;
    static std::string float_text(double v);  // with a point or an exponent
};

/// The snippets of a shader and what surrounds its functions; those left out are taken from the comments of the file.
struct ShaderOptions {
    std::string sample{}, pdf{};
    std::string f{}, f_cos{};  // without and with the cosine; one of them
    std::map<std::string, ShaderValue> set{};
    std::vector<std::string> let{};
    int numbers = 0;  // random numbers of a sample, 1 to 8; 0: default
    std::vector<std::string> include{};
    std::map<std::string, std::string> define{};
    std::vector<std::string> prelude{}, random{};
    std::string up{}, frame{};      // "x", "y" or "z"; "local" or "world"
    std::string domain{}, sides{};  // of docs/domains.md; "upper", "both" or "none"
    std::vector<double> eta{};      // of all channels or of each, below over above
    int channels = 0;               // of f and the weight, 1 or 3; 0: by their type
    bool reciprocal = true;         // false: f is known not to be reciprocal
    bool importance = false;        // f is scaled by eta^2 as importance is
    std::string name{};             // in reports; "": the name of the file
    std::string device{};           // a part of an adapter's name
    PipeLimits limits{};
};

/// Starts the process that evaluates the file:
///
///   EXPECT_THAT(crescent::shader_sampler("ggx.wgsl", {.sample = "wi = ggx_sample(wo, u, alpha)",
///                   .pdf = "ggx_pdf(wo, wi, alpha)", .set = {{"alpha", 0.3}}}),
///       crescent::IsARightSampler());
///
/// It runs python3, or the interpreter in CRESCENT_PYTHON, with the package crescent-bench[shader]. Throws InputError
/// for a mistake in the file or a snippet, with its place; OutputError if the package, a compiler or a driver is
/// missing.
std::shared_ptr<const SamplerAdapter> shader_sampler(const std::string& file, const ShaderOptions& options = {});

}  // namespace crescent
