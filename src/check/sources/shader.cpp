// The words of a command that starts the host of shaders, crescent_shader.
#include "check/sources/shader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "check/sources/pipe.h"
#include "output/format.h"

namespace crescent {

namespace {

std::vector<std::string> words_of(const ShaderOptions& options) {
    std::vector<std::string> out;
    const auto add = [&](const std::string& option, const std::string& value) {
        if (!value.empty()) out.push_back(option + value);
    };
    const auto add_each = [&](const std::string& option, const std::vector<std::string>& values) {
        for (const std::string& value : values) add(option, value);
    };
    add("--sample=", options.sample);
    add("--pdf=", options.pdf);
    add("--f=", options.f);
    add("--f-cos=", options.f_cos);
    for (const auto& [name, value] : options.set) add("--set=", name + "=" + value.text());
    add_each("--let=", options.let);
    if (options.numbers != 0) add("--numbers=", std::to_string(options.numbers));
    add_each("-I", options.include);
    for (const auto& [name, value] : options.define) add("-D", name + (value.empty() ? "" : "=" + value));
    add_each("--prelude=", options.prelude);
    add_each("--random=", options.random);
    add("--up=", options.up);
    add("--frame=", options.frame);
    add("--domain=", options.domain);
    add("--sides=", options.sides);
    add("--eta=", fmt::format("{}", fmt::join(options.eta, ",")));
    if (options.channels != 0) add("--channels=", std::to_string(options.channels));
    if (!options.reciprocal) out.emplace_back("--no-reciprocal");
    if (options.importance) out.emplace_back("--transport=importance");
    add("--name=", options.name);
    add("--device=", options.device);
    return out;
}

}  // namespace

std::string ShaderValue::float_text(double v) {
    const std::string text = shortest(v);
    return text.find_first_of(".en") == text.npos ? text + ".0" : text;
}

ShaderValue::ShaderValue(std::initializer_list<double> vector) {
    for (const double v : vector) text_ += (text_.empty() ? "" : ",") + float_text(v);
}

std::shared_ptr<const SamplerAdapter> shader_sampler(const std::string& file, const ShaderOptions& options) {
    return start_shader(file, words_of(options), options.limits);
}

}  // namespace crescent
