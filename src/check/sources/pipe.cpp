// Rows of a request are sent as lines or blocks, and the answers are rows of doubles in both formats. Directions below
// the horizon are not sent to a sampler of the hemisphere. One request along the normal determines whether the program
// has an f.
#include "check/sources/pipe.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <mutex>
#include <regex>
#include <set>
#include <vector>

#include "base/errors.h"
#include "base/process.h"
#include "base/text.h"
#include "check/sources/check_case.h"
#include "check/sources/copies.h"
#include "check/sources/external.h"
#include "check/sources/neighbours.h"
#include "check/sources/pipe_io.h"
#include "check/sources/random_numbers.h"
#include "samplers/batch_sampler.h"
#include "samplers/surface_context.h"

namespace crescent {

namespace {

/// A multiple of 2^-24, which single precision represents exactly: u itself, or else an odd one, the middle of an
/// interval of 2^-23. Multiples rounded down would favour one side of every threshold within the sampler.
double for_float(double u) {
    const double steps = u * 0x1p24;
    const auto lower = static_cast<std::uint32_t>(steps);
    const bool is_multiple = lower == steps;
    return std::min((is_multiple ? lower : lower | 1) * 0x1p-24, 1 - 0x1p-24);
}

/// The mistake that a program found in its input: "FILE:LINE:COLUMN: TEXT", "FILE: TEXT" or TEXT about `label`.
InputError error_of_program(std::string_view text, const std::string& label) {
    static const std::regex with_line("(.+?):([0-9]{1,9})(?::([0-9]{1,9}))?: (.*)");
    std::cmatch part;
    if (std::regex_match(text.begin(), text.end(), part, with_line)) {
        const auto number = [](const std::csub_match& digits) {
            return static_cast<unsigned>(std::stoul(digits.str()));
        };
        const std::string file = printable(part[1].str()), message = printable(part[4].str());
        if (part[3].matched) return InputError({file, number(part[2]), number(part[3])}, message);
        return InputError({file + ":" + part[2].str(), 0, 0}, message);
    }
    if (text.starts_with(label + ": ")) text.remove_prefix(label.size() + 2);
    return InputError({label, 0, 0}, printable(text));
}

class PipeSampler : public BatchSampler {
public:
    PipeSampler(const std::string& command, const PipeLimits& limits, const std::string& label,
        const std::optional<Domain>& domain, int neighbours, bool offers_memory)
        : connection_(command, limits, label, offers_memory), neighbours_(neighbours) {
        try {
            handshake_with_program(label, domain);
        } catch (const ProgramEnded& error) {
            connection_.stop();
            const bool is_unknown = error.end.code == 126 || error.end.code == 127;  // of the shell
            if (is_unknown && hello_.name.empty())
                throw InputError({"--exec", 0, 0}, "the shell cannot start '" + printable(command) + "'");
            throw;
        } catch (...) {
            connection_.stop();
            throw;
        }
    }
    ~PipeSampler() override { connection_.stop(); }
    PipeSampler(const PipeSampler&) = delete;
    PipeSampler& operator=(const PipeSampler&) = delete;

    SamplerDeclaration declaration() const override {
        return {.name = hello_.name,
            .traits = hello_.traits,
            .has_f = has_f_,
            .has_drawn_f = has_f_ || hello_.weight,
            .serial = true,
            .limited = true,
            .uses = hello_.uses,
            .costly_query = hello_.memory,
            .device = hello_.device};
    }
    QueryUsage spending() const override { return connection_.spending(); }

    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override {
        const std::lock_guard<std::mutex> one_at_a_time(lock_);
        BatchSampler::evaluate(query, out);
    }

private:
    mutable PipeConnection connection_;
    int neighbours_;
    const char* f_operation() const { return hello_.traits.reciprocal_weight ? "trgt" : "f___"; }
    const char* f_verb() const { return hello_.traits.reciprocal_weight ? "target" : "f"; }
    static constexpr std::size_t example_lights = 1;  // of example_context()
    Handshake hello_;
    std::vector<double> example_;  // the columns of the context in a check
    bool has_f_ = false;
    mutable std::mutex lock_;
    // Rows of the last query, guarded by lock_; factors_: of an answer, 0 without a request.
    mutable std::vector<double> request_, answers_, factors_;

    /// Calls work(w_o, rows, context) for the runs of a query: those of a scene, or all rows at the example.
    template <class Work> void for_each_run(const SamplerQuery& query, const Work& work) const {
        if (!query.scene) return work(query.wo, query.rows(), example_);
        std::vector<double> context;
        for (std::size_t r = 0; r < query.scene->runs.size(); ++r) {
            const SurfaceRun& run = query.scene->runs[r];
            context.clear();
            add_context(hello_.uses, run, query.scene->lights, query.scene->lights_of_run(r), context);
            work(run.wo, run.rows, context);
        }
    }
    static std::size_t lights_of(const SamplerQuery& query) {
        return query.scene ? query.scene->lights.size() : example_lights;
    }

    void draw_rows(const SamplerQuery& query, std::span<Draw> out) const override {
        const std::size_t lights = lights_of(query), numbers = own_numbers();
        std::vector<double> room, columns;
        std::span<const double> u = query.u.packed(numbers, room);
        const std::span<double> in = first_of(request_, out.size() * columns_of_sample(lights));
        double* to = in.data();
        for_each_run(query, [&](Vec3d wo, std::size_t rows, const std::vector<double>& context) {
            columns = context;
            if (hello_.merge) add_neighbours(neighbours_of(wo, neighbours_), columns);
            to = write_rows(wo, u.first(rows * numbers), columns, to);
            u = u.subspan(rows * numbers);
        });
        std::vector<PrimarySample> sample_room;  // which spread a point of the domain
        if (domain()) {
            const std::span<const PrimarySample> samples = query.u.samples(sample_room);
            query_samples(in, lights, out.size(),
                [&](std::size_t i, std::span<const double> a, bool) { out[i] = drawn_point(a, samples[i]); });
        } else {
            query_samples(in, lights, out.size(),
                [&](std::size_t i, std::span<const double> a, bool delta) { out[i] = draw_of(a, delta); });
        }
    }
    void pdf_rows(const SamplerQuery& query, std::span<double> out) const override {
        values("pdf_", "pdf", "one number", query, 1, out);
    }
    void f_rows(const SamplerQuery& query, std::span<double> out) const override {
        if (hello_.traits.channels == 1) return values(f_operation(), f_verb(), "one number", query, 1, out);
        std::vector<Vec3d> by_channel(out.size());
        f_rows_by_channel(query, by_channel);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = luminance(by_channel[i]);
    }
    void f_rows_by_channel(const SamplerQuery& query, std::span<Vec3d> out) const override {
        if (hello_.traits.channels == 1) return BatchSampler::f_rows_by_channel(query, out);
        std::vector<double> answers(3 * out.size());
        values("f___", "f", "three numbers, one a channel", query, 3, answers);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = {answers[3 * i], answers[3 * i + 1], answers[3 * i + 2]};
    }

    std::size_t own_numbers() const { return static_cast<std::size_t>(hello_.traits.own_numbers()); }
    const DomainChart* domain() const { return hello_.traits.domain.get(); }
    /// Columns of w_o and of a point in a row.
    std::size_t columns_of_wo() const {
        return (domain() || is_number()) && hello_.traits.wo == Traits::WoDomain::none ? 0 : 3;
    }
    std::size_t columns_of_point() const { return domain() ? domain()->domain().coordinates() : 3; }
    bool is_number() const { return hello_.traits.number; }
    std::size_t weights() const {
        return hello_.weight || is_number() ? static_cast<std::size_t>(hello_.traits.channels) : 0;
    }
    /// Columns of the answer to a request for a sample.
    std::size_t columns_of_draw() const { return (is_number() ? 0 : columns_of_point() + pdf_columns()) + weights(); }
    /// Whether an answer has a pdf next to the weight.
    std::size_t pdf_columns() const { return hello_.traits.reciprocal_weight ? 0 : 1; }
    Vec3d wo_to_send(Vec3d wo) const { return hello_.traits.wo == Traits::WoDomain::none ? Vec3d{0, 0, 1} : wo; }
    std::string sample_expected() const {
        std::string out =
            hello_.weight ? fmt::format("{} numbers 'wix wiy wiz pdf", 4 + weights()) : "four numbers 'wix wiy wiz pdf";
        if (hello_.traits.reciprocal_weight)
            return fmt::format(
                "{} numbers, {} and W", columns_of_point() + 1, domain() ? "the point's coordinates" : "w_i");
        if (is_number()) return weights() == 1 ? "one number, the value" : "three numbers, a value for each channel";
        if (domain())
            out = fmt::format("{} numbers '{} pdf", columns_of_point() + 1 + weights(),
                columns_of_point() == 1 ? "x" : "the point's coordinates,");
        if (hello_.weight) out += weights() == 1 ? " weight" : " weight weight weight";
        return out + (hello_.delta ? "', or 'delta q' in place of pdf" : "'");
    }
    static PipeConnection::Write writer(const char* verb, std::size_t columns, std::span<const double> in) {
        return [verb, columns, in](std::size_t i, std::string& line) {
            line = verb;
            for (std::size_t k = 0; k < columns; ++k) append(line, in[i * columns + k]);
        };
    }
    double number_for(double u) const { return hello_.traits.u_bits == 53 ? u : for_float(u); }
    std::size_t columns_of_sample(std::size_t lights) const {
        const std::size_t merge_columns =
            hello_.merge ? 1 + Neighbour::columns * static_cast<std::size_t>(neighbours_) : std::size_t{0};
        return columns_of_wo() + own_numbers() + context_columns(hello_.uses, lights) + merge_columns;
    }
    /// Writes the rows of a request for samples at one w_o. u: their random numbers, row by row. Returns the end.
    double* write_rows(Vec3d wo, std::span<const double> u, std::span<const double> context, double* to) const {
        const std::size_t numbers = own_numbers();
        for (std::size_t k = 0; k < u.size(); k += numbers) {
            to = write_wo(wo, to);
            for (const double number : u.subspan(k, numbers)) *to++ = number_for(number);
            to = std::copy(context.begin(), context.end(), to);
        }
        return to;
    }
    /// The first `size` values of a buffer, which grows and is kept.
    static std::span<double> first_of(std::vector<double>& buffer, std::size_t size) {
        if (buffer.size() < size) buffer.resize(size);
        return std::span(buffer).first(size);
    }
    /// Returns the end of its columns.
    double* write_wo(Vec3d wo, double* to) const {
        if (columns_of_wo() == 0) return to;
        const Vec3d direction = wo_to_send(wo);
        to[0] = direction.x;
        to[1] = direction.y;
        to[2] = direction.z;
        return to + 3;
    }
    /// Writes w_i, or the point that it is. Returns the factor of a density there, 0 if there is no point.
    double write_point(Vec3d wi, double* to) const {
        if (domain()) return domain()->point(wi, {to, columns_of_point()});
        to[0] = wi.x;
        to[1] = wi.y;
        to[2] = wi.z;
        return 1;
    }
    /// Requests samples for rows of w_o, u and the context; calls take(i, answer, delta) for each row in order.
    template <class Take>
    void query_samples(std::span<const double> in, std::size_t lights, std::size_t count, const Take& take) const {
        const std::size_t request_columns = columns_of_sample(lights), answer_columns = columns_of_draw();
        const std::span<double> answers = first_of(answers_, count * answer_columns);
        std::vector<bool> delta(hello_.blocks() ? 0 : count);
        if (hello_.blocks()) query_block("smpl", "sample", count, request_columns, answer_columns, in, answers, lights);
        else
            connection_.lines(count, sample_expected(), writer("sample", request_columns, in),
                [&](std::size_t i, std::string_view s) {
                    return read_sample(s, answers.subspan(i * answer_columns, answer_columns), delta, i);
                });
        for (std::size_t i = 0; i < count; ++i)
            take(i, answers.subspan(i * answer_columns, answer_columns), !hello_.blocks() && delta[i]);
    }
    void query_block(const char* operation, const char* verb, std::size_t count, std::size_t request_columns,
        std::size_t answer_columns, std::span<const double> in, std::span<double> out, std::size_t lights) const {
        if (count == 0) return;
        std::string header;
        const auto add_count = [&](std::size_t number) {
            for (int byte = 0; byte < 4; ++byte) header += static_cast<char>(number >> (8 * byte) & 255);
        };
        if (hello_.uses_lights()) add_count(lights);
        if (hello_.merge && std::string_view(verb) == "sample") add_count(static_cast<std::size_t>(neighbours_));
        const PipeConnection::Write write = writer(verb, request_columns, in);
        connection_.blocks({.operation = operation,
            .count = count,
            .in = in,
            .out = out,
            .is_single = hello_.single_blocks(),
            .expected =
                fmt::format("a block of {} {} a row", answer_columns, hello_.single_blocks() ? "floats" : "doubles"),
            .describe =
                [&](std::size_t i) {
                    std::string line;
                    write(i, line);
                    return line;
                },
            .header = std::move(header)});
    }

    bool read_sample(std::string_view s, std::span<double> to, std::vector<bool>& delta, std::size_t i) const {
        for (std::size_t k = 0; k < to.size(); ++k) {
            const std::size_t word = s.find_first_not_of(" \t");
            if (k == 3 && hello_.delta && word != s.npos && s.substr(word).starts_with("delta ")) {
                delta[i] = true;
                s.remove_prefix(word + 6);
            }
            if (!take_float(s, to[k])) return false;
        }
        return blank(s);
    }
    /// No sample if pdf is 0, or if the draw is below the horizon of a sampler of the hemisphere.
    Draw draw_of(std::span<const double> a, bool delta) const {
        if (is_number()) {
            Draw value{{0, 0, 1}, 1};
            take_weight(a, value);
            return value;
        }
        if (hello_.traits.reciprocal_weight) {
            Draw reservoir{{a[0], a[1], a[2]}, a[3] == 0 ? 0.0 : 1.0};
            if (hello_.hemisphere && a[2] <= 0) reservoir.pdf = 0;
            if (reservoir.pdf > 0) reservoir.weight = a[3];
            return reservoir;
        }
        Draw d{{a[0], a[1], a[2]}, a[3]};
        if (hello_.blocks() && hello_.delta && d.pdf < 0) {
            delta = true;
            d.pdf = -d.pdf;
        }
        const bool is_empty = !delta && d.pdf == 0;
        const auto weight = a.subspan(4);
        const bool is_finite = std::ranges::all_of(weight, [](double v) { return std::isfinite(v); });
        if (is_empty && !is_finite) return {{0, 0, 1}, 0, std::nan("")};
        if (is_empty || (hello_.hemisphere && d.wi.z <= 0 && d.pdf >= 0)) return {{0, 0, 1}, 0};
        if (!hello_.traits.has_pdf && d.pdf > 0) d.pdf = 1;
        if (delta) {
            d.delta = d.pdf != 0 ? d.pdf : delta_never_chosen;
            d.pdf = 0;
        }
        take_weight(weight, d);
        return d;
    }
    static void take_weight(std::span<const double> weight, Draw& d) {
        if (weight.size() == 1) d.weight = weight[0];
        if (weight.size() == 3) {
            d.weights = {weight[0], weight[1], weight[2]};
            d.weight = luminance(d.weights);
        }
    }
    /// a: the coordinates of a point of the domain, its pdf and weights.
    Draw drawn_point(std::span<const double> a, const PrimarySample& u) const {
        const std::size_t columns = columns_of_point();
        // W of a reservoir represents the pdf: 0 is no sample.
        Draw d = draw_of_point(*domain(), a.first(columns), a[columns], u, hello_.traits.own_numbers());
        if (!hello_.traits.has_pdf && d.pdf > 0) d.pdf = 1;
        if (d.pdf > 0) take_weight(a.subspan(columns + pdf_columns()), d);
        return d;
    }

    /// pdf or f; both are 0, without a request, below the horizon of a sampler of the hemisphere.
    void values(const char* operation, const char* verb, std::string_view expected, const SamplerQuery& query,
        std::size_t columns, std::span<double> out) const {
        const std::span<const Pair> pairs = query.pairs;
        const std::size_t lights = lights_of(query);
        const std::size_t request_columns = columns_of_wo() + columns_of_point() + context_columns(hello_.uses, lights);
        const std::span<double> room = first_of(request_, pairs.size() * request_columns),
                                factor = first_of(factors_, pairs.size());
        double* to = room.data();
        std::size_t row = 0;
        for_each_run(query, [&](Vec3d, std::size_t rows, const std::vector<double>& context) {
            for (const std::size_t end = row + rows; row < end; ++row) {
                const Pair& p = pairs[row];
                factor[row] = 0;
                if (hello_.hemisphere && !(p.wi.z > 0)) continue;
                double* const point = write_wo(p.wo, to);
                factor[row] = write_point(p.wi, point);
                if (operation[0] == 'f' && hello_.f_cos && !domain())
                    factor[row] = p.wi.z != 0 ? 1 / std::fabs(p.wi.z) : 0;
                if (factor[row] > 0) to = std::copy(context.begin(), context.end(), point + columns_of_point());
            }
        });
        const std::span<double> in = room.first(static_cast<std::size_t>(to - room.data()));
        const std::size_t count = in.size() / request_columns;
        const std::span<double> answers = first_of(answers_, count * columns);
        if (hello_.blocks()) query_block(operation, verb, count, request_columns, columns, in, answers, lights);
        else if (count > 0)
            connection_.lines(
                count, expected, writer(verb, request_columns, in), [&](std::size_t i, std::string_view s) {
                    if (operation[0] == 'f' && s == "-") {
                        std::ranges::fill(answers.subspan(i * columns, columns), std::nan(""));
                        return true;
                    }
                    for (std::size_t k = 0; k < columns; ++k)
                        if (!take_float(s, answers[i * columns + k])) return false;
                    return blank(s);
                });
        std::size_t next = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const bool is_requested = factor[i] > 0;
            for (std::size_t k = 0; k < columns; ++k)
                out[i * columns + k] = is_requested ? answers[next * columns + k] * factor[i] : 0;
            next += is_requested;
        }
    }

    void handshake_with_program(const std::string& label, const std::optional<Domain>& expected_domain) {
        connection_.lines(
            1, handshake_form, [](std::size_t, std::string& line) { line = "hello 2"; },
            [&](std::size_t, std::string_view s) {
                if (s.starts_with("error ")) throw error_of_program(s.substr(6), label);
                if (s.starts_with("missing ")) throw OutputError(label + ": " + printable(s.substr(8)));
                Handshake hello;
                if (expected_domain) {
                    hello.hemisphere = expected_domain->name() == "hemisphere";
                    if (!expected_domain->is_direction()) hello.domain = expected_domain;
                }
                if (const HandshakeError fault = read_handshake(s, hello); fault)
                    connection_.fault("hello 2", 0, fault.answer_text, fault.expected);
                if (hello.memory && !connection_.use_memory())
                    connection_.fault("hello 2", 0, "got memory=yes", "no memory=, since none was offered");
                const std::string domain_name = hello.traits.number ? "number"
                    : hello.domain                                  ? hello.domain->name()
                    : hello.hemisphere                              ? "hemisphere"
                                                                    : "sphere";
                if (expected_domain && domain_name != expected_domain->name())
                    throw InputError({"--domain " + expected_domain->name(), 0, 0},
                        "the program draws " + domain_name + " by its handshake");
                hello_ = hello;
                hello_.traits.neighbours = hello.merge ? neighbours_ : 0;
                example_ = example_context(hello.uses);
                return true;
            });
        connection_.finish_handshake();
        if (domain()) fit_domain();
        has_f_ = hello_.traits.reciprocal_weight;
        if (!is_number() && !has_f_) probe_f();
    }
    /// Fits the charts of infinite lines to draws, over all w_o that the program takes.
    void fit_domain() {
        if (!domain()->domain().is_infinite()) return;
        std::vector<double> in(draws_of_chart * columns_of_sample(example_lights)), points;
        const std::size_t numbers = own_numbers();
        double theta = 0;  // degrees
        double* to = in.data();
        for (const PrimarySample& u : numbers_of_chart(hello_.traits.own_numbers())) {
            std::array<double, PrimarySample::most_numbers> row{};
            for (std::size_t k = 0; k < numbers; ++k) row[k] = u[static_cast<int>(k)];
            theta = theta < 75 ? theta + 15 : 15;
            to = write_rows(tilt(theta), std::span(row).first(numbers), example_, to);
        }
        query_samples(in, example_lights, draws_of_chart, [&](std::size_t, std::span<const double> a, bool) {
            const std::span<const double> point = a.first(columns_of_point());
            if (a[point.size()] > 0) points.insert(points.end(), point.begin(), point.end());
        });
        auto chart = std::make_shared<DomainChart>(*domain());
        chart->fit(points);
        hello_.traits.domain = std::move(chart);
    }
    /// Determines whether there is a BRDF: none if the answer is `-` or, in blocks, NaN at all of these pairs of
    /// directions. At w_o = w_i = n alone a BRDF may fail.
    void probe_f() {
        std::vector<Pair> oblique;  // on no axis or plane, and of which none mirrors another
        for (int k = 0; k < 8; ++k) {
            const double x = k & 1 ? -1 : 1, y = k & 2 ? -1 : 1, z = k & 4 ? -1 : 1;
            oblique.push_back({tilt(35 + k, 17 + 40 * k), normalize(Vec3d{0.48 * x, 0.36 * y, 0.8 * z})});
        }
        has_f_ = answers_f({{{0, 0, 1}, {0, 0, 1}}}) || (hello_.blocks() && answers_f(oblique));
    }
    /// Whether f is a number at one of these pairs.
    bool answers_f(const std::vector<Pair>& pairs) {
        const std::size_t columns = static_cast<std::size_t>(hello_.traits.channels);
        const std::size_t request_columns = columns_of_wo() + columns_of_point() + example_.size();
        std::vector<double> in(request_columns * pairs.size());
        double* to = in.data();
        for (const Pair& pair : pairs) {
            double* const point = write_wo(pair.wo, to);
            write_point(pair.wi, point);
            to = std::copy(example_.begin(), example_.end(), point + columns_of_point());
        }
        std::vector<double> answer(pairs.size() * columns);
        bool has_number = false;
        if (hello_.blocks()) {
            query_block("f___", "f", pairs.size(), request_columns, columns, in, answer, example_lights);
            for (std::size_t i = 0; i < pairs.size(); ++i) has_number = has_number || !std::isnan(answer[i * columns]);
            return has_number;
        }
        connection_.lines(pairs.size(),
            columns == 1 ? "one number, or '-' where there is no BRDF"
                         : "three numbers, one a channel, or '-' where there is no BRDF",
            writer("f", request_columns, in), [&](std::size_t i, std::string_view s) {
                if (s == "-") return true;
                has_number = true;
                for (std::size_t k = 0; k < columns; ++k)
                    if (!take_float(s, answer[i * columns + k])) return false;
                return blank(s);
            });
        return has_number;
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> start_pipe(const std::string& command, const PipeLimits& limits,
    const std::string& label, const std::optional<Domain>& domain, int neighbours) {
    return std::make_shared<PipeSampler>(command, limits, label.empty() ? command : label, domain, neighbours, false);
}

// ---- A table of keys with their values, from which the messages are made too. The name is the text before the first
// word with '='.

namespace {

bool one_of(std::string_view value, std::initializer_list<std::string_view> words, int& index) {
    index = 0;
    for (std::string_view w : words) {
        if (w == value) return true;
        ++index;
    }
    return false;
}

bool whole_number(std::string_view value, int low, int high, int& out) {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), out);
    return error == std::errc{} && end == value.data() + value.size() && out >= low && out <= high;
}

/// One index, or one for each channel, separated by commas.
bool indices(std::string_view value, std::optional<Vec3d>& out) {
    std::vector<double> v;
    std::string text(value);
    for (char& c : text)
        if (c == ',') c = ' ';
    for (std::string_view remainder = text; !blank(remainder);) {
        v.emplace_back();
        if (!take_float(remainder, v.back()) || !(v.back() > 0) || !(v.back() < 1e6)) return false;
    }
    if (v.size() != 1 && v.size() != 3) return false;
    out = v.size() == 1 ? Vec3d{v[0], v[0], v[0]} : Vec3d{v[0], v[1], v[2]};
    return true;
}

constexpr const char* text_of_word = "a text in which %20 is a space and %25 is %";

/// The text of a word in which %HH is the byte HH (RFC 3986, 2.1).
bool decode_word(std::string_view value, std::string& out) {
    constexpr std::size_t longest = 200;  // bytes; names of adapters have below 100
    std::string text;
    for (std::size_t i = 0; i < value.size(); ++i) {
        unsigned byte = 0;
        if (value[i] != '%') {
            text += value[i];
            continue;
        }
        const std::string_view digits = value.substr(i + 1, 2);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
        if (error != std::errc{} || digits.size() != 2 || end != digits.data() + 2) return false;
        text += static_cast<char>(byte);
        i += 2;
    }
    out = printable(text, longest);
    return !out.empty();
}

const std::string number_or_domain = std::string("number, ") + Domain::expected;

struct HandshakeKey {
    const char* name;
    const char* values;
    std::function<bool(std::string_view, Handshake&)> read;
};

const std::array<HandshakeKey, 20>& keys() {
    using S = std::string_view;
    static const std::array<HandshakeKey, 20> handshake_keys = {{
        {"u", "a whole number from 1 to 8",
            [](S v, Handshake& g) { return whole_number(v, 1, PrimarySample::most_numbers, g.traits.numbers); }},
        {"domain", number_or_domain.c_str(),
            [](S v, Handshake& g) {
                g.domain.reset();
                if ((g.traits.number = v == "number")) return true;
                const std::optional<Domain> domain = Domain::read(v);
                g.hemisphere = v == "hemisphere";
                if (domain && !domain->is_direction()) g.domain = domain;
                return domain.has_value();
            }},
        {"wo", "upper, both or none",
            [](S v, Handshake& g) {
                int index = 0;
                const bool is_word = one_of(v, {"upper", "both", "none"}, index);
                g.states_wo = true;
                g.traits.wo = index == 1 ? Traits::WoDomain::both
                    : index == 2         ? Traits::WoDomain::none
                                         : Traits::WoDomain::upper;
                return is_word;
            }},
        {"channels", "1 or 3",
            [](S v, Handshake& g) { return whole_number(v, 1, 3, g.traits.channels) && g.traits.channels != 2; }},
        {"weight", "yes, no or reciprocal",
            [](S v, Handshake& g) {
                g.traits.reciprocal_weight = v == "reciprocal";
                g.weight = v == "yes" || g.traits.reciprocal_weight;
                return g.weight || v == "no";
            }},
        {"merge", "yes or no", [](S v, Handshake& g) { return (g.merge = v == "yes") || v == "no"; }},
        {"delta", "yes or no", [](S v, Handshake& g) { return (g.delta = v == "yes") || v == "no"; }},
        {"pdf", "yes or no", [](S v, Handshake& g) { return (g.traits.has_pdf = v == "yes") || v == "no"; }},
        {"f", "cos or nocos", [](S v, Handshake& g) { return (g.f_cos = v == "cos") || v == "nocos"; }},
        {"eta", "a number over 0 and under 1e6, or three separated by commas",
            [](S v, Handshake& g) { return indices(v, g.traits.eta); }},
        {"transport", "radiance or importance",
            [](S v, Handshake& g) { return (g.traits.importance = v == "importance") || v == "radiance"; }},
        {"reciprocal", "yes or no", [](S v, Handshake& g) { return (g.traits.reciprocal = v == "yes") || v == "no"; }},
        {"random", "own or given",
            [](S v, Handshake& g) { return (g.traits.own_random = v == "own") || v == "given"; }},
        {"real", "f32 or f64",
            [](S v, Handshake& g) {
                g.traits.bits = v == "f32" ? 24 : 53;
                g.device.precision = v == "f32" ? "single" : "double";
                return v == "f32" || v == "f64";
            }},
        {"u_bits", "24 or 53",
            [](S v, Handshake& g) {
                g.traits.u_bits = v == "53" ? 53 : 24;
                return v == "53" || v == "24";
            }},
        {"device", text_of_word, [](S v, Handshake& g) { return decode_word(v, g.device.name); }},
        {"driver", text_of_word, [](S v, Handshake& g) { return decode_word(v, g.device.driver); }},
        {"block", "f32 or f64",
            [](S v, Handshake& g) {
                g.block_number = v == "f32" ? sizeof(float) : sizeof(double);
                return v == "f32" || v == "f64";
            }},
        {"memory", "yes or no", [](S v, Handshake& g) { return (g.memory = v == "yes") || v == "no"; }},
        {"uses", "names from s, alpha, rho_d, rho_s, side, eta and lights, separated by commas",
            [](S v, Handshake& g) { return take_context_names(v, g.uses); }},
    }};
    return handshake_keys;
}

HandshakeError unknown(std::string_view name) {
    std::vector<std::string> names;
    for (const HandshakeKey& k : keys()) names.emplace_back(k.name);
    return {fmt::format("one of {} before the '='", fmt::join(names, ", ")),
        fmt::format("got the unknown key {}{}", quote(name), did_you_mean(name, names))};
}

HandshakeError read_key(std::string_view word, Handshake& out) {
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals), value = equals == word.npos ? "" : word.substr(equals + 1);
    if (equals == word.npos) return {"KEY=VALUE", fmt::format("got the word {} after the keys", quote(word))};
    for (const HandshakeKey& k : keys()) {
        if (name != k.name) continue;
        if (k.read(value, out)) return {};
        return {fmt::format("{} for {}", k.values, k.name), "got " + quote(value)};
    }
    return unknown(name);
}

/// The end of KEY=VALUE. The names of a product of domains may have spaces about their x.
std::size_t end_of_word(std::string_view text) {
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    if (!text.starts_with("domain=")) return end;
    std::size_t position = end;
    for (std::string_view remainder = text.substr(end); remainder.starts_with(" x ") && remainder.size() > 3;
        remainder = text.substr(position))
        position += 3 + std::min(remainder.substr(3).find_first_of(" \t"), remainder.size() - 3);
    return position;
}

/// What the domain decides: without wo=, no w_o; and the numbers that spread a point.
HandshakeError settle_domain(Handshake& out) {
    if (out.merge) {
        if (!out.traits.reciprocal_weight || out.domain || out.traits.wo == Traits::WoDomain::none)
            return {"weight=reciprocal, directions and a w_o with merge=yes", "got none of one of them"};
        if (!out.uses.empty()) return {"no uses= with merge=yes", "got uses="};
    }
    if (out.traits.reciprocal_weight) {
        if (out.delta || out.traits.channels != 1)
            return {"channels=1 and no delta=yes with weight=reciprocal", "got one of them"};
        out.traits.has_pdf = false;
    }
    if (out.traits.number) {
        if (out.delta || out.weight || !out.uses.empty())
            return {"no delta=, weight= and uses= with domain=number", "got one of them"};
        out.traits.wo = Traits::WoDomain::none;
        out.traits.has_pdf = false;
        return {};
    }
    if (!out.domain) return {};
    const auto chart = std::make_shared<const DomainChart>(*out.domain);
    if (const int limit = most_numbers(*chart); out.traits.numbers > limit)
        return {fmt::format("at most {} random numbers for this domain", limit),
            fmt::format("got u={}", out.traits.numbers)};
    if (out.delta) return {"no delta=yes for a domain that is not of directions", "got delta=yes"};
    if (!out.uses.empty()) return {"no uses= for a domain that is not of directions", "got uses="};
    out.traits.numbers += static_cast<int>(chart->spreads());
    out.traits.domain = chart;
    if (!out.states_wo) out.traits.wo = Traits::WoDomain::none;
    return {};
}

}  // namespace

HandshakeError read_handshake(std::string_view answer, Handshake& out) {
    constexpr std::string_view start = "hello 2 ";
    for (const char* version : {"hello 1 ", "hello 3 "})
        if (answer.starts_with(version))
            return {handshake_form,
                fmt::format(
                    "got {}; write {}", quote(answer), quote(fmt::format("{}{}", start, answer.substr(start.size()))))};
    if (!answer.starts_with(start) || blank(answer.substr(start.size())))
        return {handshake_form, "got " + quote(answer) + only_answers};
    std::string_view remainder = answer.substr(start.size()), name = remainder;
    const std::size_t key = remainder.find('=');
    if (key != remainder.npos) {
        const std::size_t name_end = remainder.find_last_of(" \t", key);
        if (name_end == remainder.npos || blank(remainder.substr(0, name_end)))
            return {handshake_form, "got no name in " + quote(answer)};
        name = remainder.substr(0, name_end);
        remainder = remainder.substr(name_end);
        std::set<std::string_view> names;
        while (!blank(remainder)) {
            remainder.remove_prefix(remainder.find_first_not_of(" \t"));
            const std::size_t end = end_of_word(remainder);
            if (const HandshakeError fault = read_key(remainder.substr(0, end), out); fault) return fault;
            const std::string_view key_name = remainder.substr(0, remainder.find('='));
            if (!names.insert(key_name).second)
                return {"each key once", fmt::format("got the key {} twice", quote(key_name))};
            remainder.remove_prefix(end);
        }
    }
    name.remove_prefix(name.find_first_not_of(" \t"));
    while (name.ends_with(' ') || name.ends_with('\t')) name.remove_suffix(1);
    out.name = printable(name, 60);
    if (out.delta && !out.weight)
        return {"weight=yes with delta=yes, since a draw of a delta part needs its weight", "got no weight=yes"};
    if (out.memory && !out.blocks()) return {"block= with memory=yes", "got no block="};
    if (out.single_blocks() && out.traits.u_bits > 24)
        return {"u_bits=24 with block=f32, whose numbers have 24 bits", "got u_bits=53"};
    out.traits.delta = out.delta;
    return settle_domain(out);
}

// ---- Python files: crescent.serve of the Python package answers in the same protocol.

bool names_python_sampler(const std::string& word) {
    if (word.ends_with(".py")) return true;
    const auto is_name_char = [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    const std::size_t colon = word.rfind(':');
    if (colon == std::string::npos || colon == 0) return false;
    const std::string module = word.substr(0, colon), name = word.substr(colon + 1);
    if (name.empty() || !std::ranges::all_of(name, is_name_char)) return false;
    return module.ends_with(".py") || std::ranges::all_of(module, [&](char c) { return is_name_char(c) || c == '.'; });
}

namespace {

std::string python_interpreter() {
    const char* path = std::getenv("CRESCENT_PYTHON");
    return path && *path ? path : "python3";
}

/// Whether the interpreter finds a module. It is started for that, at most this long.
bool can_import(const char* module) {
    constexpr int longest_ms = 20000;
    const std::string python = python_interpreter();
    ProcessPlan plan{.argv = {python, "-P", "-c", fmt::format("import {}", module)}};
    plan.stdin_file = plan.stdout_file = plan.stderr_file = "/dev/null";
    try {
        Process process(plan);
        const std::optional<ProcessEnd> end = process.ended(longest_ms);
        return end && end->well();
    } catch (const OutputError&) { return false; }
}

/// Starts a module of the package `package`, which answers for the file `label`.
std::shared_ptr<const SamplerAdapter> start_python_module(const char* module, const std::vector<std::string>& words,
    const char* package, const PipeLimits& limits, const std::string& label, int neighbours, bool offers_memory) {
    // An interpreter that the shell cannot start (126, 127) is reported in the same way as a missing package.
    const std::string command =
        python_command(module, words) + "; code=$?; [ $code -lt 126 ] || [ $code -gt 127 ] || code=1; exit $code";
    try {
        return std::make_shared<PipeSampler>(command, limits, label, std::nullopt, neighbours, offers_memory);
    } catch (const ProgramEnded& error) {
        if (error.end.code != 1 || can_import(module)) throw;  // what the user's file did
        throw OutputError(fmt::format(
            "{}: '{}' cannot run the module {}: install the package with `pip install {}`, or set CRESCENT_PYTHON to "
            "an interpreter that has it",
            label, python_interpreter(), module, package));
    }
}

}  // namespace

std::string python_command(const std::string& module, const std::vector<std::string>& words) {
    // -P: a file in the current folder does not replace a module that the package imports.
    std::string out = fmt::format("{} -P -m {}", shell_word(python_interpreter()), module);
    for (const std::string& word : words) out += " " + shell_word(word);
    return out;
}

std::shared_ptr<const SamplerAdapter> start_python_sampler(
    const std::string& word, const PipeLimits& limits, int neighbours) {
    return start_python_module("crescent.serve", {word}, "crescent-bench", limits, word, neighbours, false);
}

// ---- Shaders: crescent_shader of the same package.

bool names_shader(const std::string& word) {
    constexpr std::array<std::string_view, 9> suffixes = {
        ".wgsl", ".glsl", ".frag", ".comp", ".rgen", ".rchit", ".hlsl", ".hlsli", ".slang"};
    return std::ranges::any_of(suffixes, [&](std::string_view suffix) { return word.ends_with(suffix); });
}

std::shared_ptr<const SamplerAdapter> start_shader(
    const std::string& file, const std::vector<std::string>& words, const PipeLimits& limits, std::size_t shaders) {
    std::vector<std::string> arguments = {"--memory"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    arguments.insert(arguments.end(), {"--", file});
    const auto start = [=] {
        return start_python_module(
            "crescent_shader", arguments, "'crescent-bench[shader]'", limits, file, default_neighbours, true);
    };
    // While a device computes for one, another converts its numbers; a device computes on all of its cores. There are
    // no more than threads that ask.
    constexpr std::size_t most_copies = 4;
    return std::make_shared<Copies>(start, std::max<std::size_t>(most_copies / shaders, 1));
}

}  // namespace crescent
