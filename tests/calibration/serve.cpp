// The answers are those of the adapter of a user's struct, so that a case has the same draws in process and over a
// pipe.
#include "tests/calibration/serve.h"

#include <cstring>
#include <fmt/format.h>
#include <limits>

namespace crescent::calibration {

namespace {

std::string handshake(const Sampler& s) {
    const char* wo = s.wo == Traits::WoDomain::both ? "both" : s.wo == Traits::WoDomain::none ? "none" : "upper";
    std::string name = s.family;
    for (char& c : name)
        if (c == '=') c = ' ';
    std::string out = fmt::format("hello 2 {} domain=sphere wo={} u={}", name, wo, s.numbers);
    if (s.real() == Real::f32) out += " real=f32";
    if (s.eta) out += fmt::format(" eta={}", *s.eta);
    if (!s.reciprocal) out += " reciprocal=no";
    if (s.given) {
        const Traits t = s.given->traits();
        out += " weight=yes";
        if (t.delta) out += " delta=yes";
        if (!t.has_pdf) out += " pdf=no";
    }
    return out + " block=f64\n";
}

struct Request {
    char what[4];
    std::uint32_t rows;
};

void answer_samples(
    const SamplerAdapter& s, int numbers, bool weights, const std::vector<double>& in, std::vector<double>& out) {
    const std::size_t width = 3 + static_cast<std::size_t>(numbers);
    for (std::size_t r = 0; r < in.size() / width; ++r) {
        const double* row = &in[r * width];
        PrimarySample u;
        for (int k = 0; k < numbers; ++k) u[k] = row[3 + k];
        Draw d;
        s.sample(0, {row[0], row[1], row[2]}, {&u, 1}, {&d, 1});
        for (const double v : {d.wi.x, d.wi.y, d.wi.z, d.delta > 0 ? -d.delta : d.pdf}) out.push_back(v);
        if (weights) out.push_back(d.weight.value_or(0));
    }
}

void answer_values(const SamplerAdapter& s, bool pdf, const std::vector<double>& in, std::vector<double>& out) {
    std::vector<Pair> at;
    for (std::size_t r = 0; r < in.size() / 6; ++r) {
        const double* row = &in[r * 6];
        at.push_back({{row[0], row[1], row[2]}, {row[3], row[4], row[5]}});
    }
    out.assign(at.size(), std::numeric_limits<double>::quiet_NaN());
    if (pdf) s.pdf(0, at, out);
    else if (s.has_f()) s.f(at, out);
}

}  // namespace

bool serve(const Sampler& sampler, std::FILE* in, std::FILE* out) {
    const std::shared_ptr<const SamplerAdapter> adapter = make_adapter(sampler);
    char line[4096];
    if (!std::fgets(line, sizeof line, in)) return false;
    const std::string hello = handshake(sampler);
    std::fwrite(hello.data(), 1, hello.size(), out);
    std::fflush(out);
    Request request;
    std::vector<double> questions, answers;
    while (std::fread(request.what, 1, 4, in) == 4 && std::fread(&request.rows, 4, 1, in) == 1) {
        const bool samples = std::memcmp(request.what, "smpl", 4) == 0;
        questions.resize(request.rows * static_cast<std::size_t>(samples ? 3 + sampler.numbers : 6));
        if (std::fread(questions.data(), 8, questions.size(), in) != questions.size()) return false;
        answers.clear();
        if (samples) answer_samples(*adapter, sampler.numbers, sampler.given != nullptr, questions, answers);
        else answer_values(*adapter, std::memcmp(request.what, "pdf_", 4) == 0, questions, answers);
        std::fwrite(&request.rows, 4, 1, out);
        std::fwrite(answers.data(), 8, answers.size(), out);
        std::fflush(out);
    }
    return true;
}

}  // namespace crescent::calibration
