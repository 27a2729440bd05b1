// Combinations of built-in samplers without resampling are estimated by the kernels (kernel_combination.h). Others draw
// here, many shading points in one batch, and the scalar kernel takes their directions.
#include "render/combination.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"

#include "render/point_kernel.h"

namespace crescent {

namespace {

constexpr std::size_t batch_rows = 4096;       // directions of a batch: they stay in a cache of the processor
constexpr std::uint32_t selection = 0x800000;  // the block that chooses among candidates

/// The numbers of sampler k for every row.
std::vector<double> numbers_of(
    const PointRows& rows, const NumberBlocks& u, std::size_t k, std::size_t repeat, std::size_t count) {
    std::vector<double> out;
    out.reserve(rows.count() * count);
    for (std::size_t r = 0; r < rows.runs.size(); ++r)
        for (std::size_t i = 0; i < rows.runs[r].rows; ++i)
            for (std::size_t pair = 0; pair < count; pair += 2) {
                const Vec2<float> two = u(r, i, block_of(k, pair / 2, repeat));
                out.push_back(static_cast<double>(two.x));
                if (pair + 1 < count) out.push_back(static_cast<double>(two.y));
            }
    return out;
}

PointRun run_of(const ShadingPoints& points, std::size_t index, std::size_t rows) {
    return {index, {points.wox[index], points.woy[index], points.woz[index]}, rows};
}

WeightedDirection direction_of(const PointDraw& draw, double pdf, double weight) {
    WeightedDirection out;
    out.draw.wi = draw.wi;
    out.draw.pdf.v = static_cast<float>(pdf);
    out.draw.disk = draw.light;
    out.draw.meets_light = draw.meets_light;
    out.draw.texel = draw.texel;
    out.draw.triangle = draw.triangle;
    out.weight = static_cast<float>(weight);
    return out;
}

/// f L cos / (light of the scene) of a direction, without occlusion by bodies: the sum that X has if nothing is hidden.
class Products {
public:
    Products(const ShadingPoints& points, bool with_light)
        : points_(points), with_light_(with_light), memory_(points.kernel_memory()), room_(points, memory_.data()) {}

    double operator()(const PointRun& run, const PointDraw& draw) {
        const float cos = draw.wi.z;
        if (!(cos > 0)) return 0;
        const std::size_t index = run.point;
        const float lobe = points_.lobe < 0
            ? 0.0f
            : lobe_value(static_cast<LobeKind>(points_.lobe), points_.s[index], points_.alpha[index], run.wo, draw.wi);
        if (!with_light_)
            return double(cos) * (double(points_.diffuse[index]) / pi + points_.rho_s_exact[index] * double(lobe));
        const int k = light_met(run, draw);
        if (k < 0 && points_.around)
            if (const double x = around_met(run, draw, lobe); x > 0) return double(cos) * x;
        const std::size_t light = static_cast<std::size_t>(k), disks = points_.disks.size();
        const float d = k < 0 ? points_.fill_d[index]
            : light < disks   ? points_.disks[light].d[index]
                              : points_.others[light - disks].d[index];
        const float s = k < 0 ? points_.fill_s[index]
            : light < disks   ? points_.disks[light].s[index]
                              : points_.others[light - disks].s[index];
        return double(cos) * (double(d) + double(lobe) * double(s));
    }

private:
    /// X without the cosine of the emitting triangle or of the sky that the direction meets; 0: it meets neither.
    double around_met(const PointRun& run, const PointDraw& draw, float lobe) const {
        const std::size_t index = run.point;
        const Vec3f o{points_.px[index], points_.py[index], points_.pz[index]};
        const Frame<float> frame{{points_.tx[index], points_.ty[index], points_.tz[index]},
            {points_.bx[index], points_.by[index], points_.bz[index]},
            {points_.nx[index], points_.ny[index], points_.nz[index]}};
        const Vec3f d = frame.to_world(draw.wi);
        const Surroundings& surroundings = *points_.around;
        std::uint32_t triangle = draw.triangle;
        if (surroundings.triangles && triangle == no_triangle)
            triangle = surroundings.triangles->nearest(widen(o), widen(d));
        float rgb[3] = {0, 0, 0};
        if (triangle != no_triangle) triangle_radiance(surroundings, triangle, rgb);
        else sky_radiance(surroundings, draw.texel, d, rgb);
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
            sum += double(rgb[c]) * double(points_.around_d[c][index] + lobe * points_.around_s[c][index]);
        return sum;
    }

    int light_met(const PointRun& run, const PointDraw& draw) {
        if (points_.light_count() == 0) return -1;
        if (!lights_ || point_ != run.point) lights_.emplace(points_, point_ = run.point, room_);
        const WeightedDirection direction = direction_of(draw, 1, 1);
        float nearest = 1e30f;
        int light = -1;
        for (std::size_t k = 0; k < points_.disks.size(); ++k) {
            float v;
            if (!meets_disk(lights_->facing[k], direction.draw, k, false, v)) continue;
            const float t = lights_->facing[k].k / v;
            if (is_nearer(t, nearest)) {
                nearest = t;
                light = static_cast<int>(k);
            }
        }
        for (std::size_t k = points_.disks.size(); k < points_.light_count(); ++k) {
            float t;
            if (meets_light(lights_->others[k - points_.disks.size()], direction.draw, k, t) && is_nearer(t, nearest)) {
                nearest = t;
                light = static_cast<int>(k);
            }
        }
        return light;
    }

    const ShadingPoints& points_;
    bool with_light_;
    std::vector<std::byte> memory_;
    scalar::LightRoom<float> room_;
    std::optional<scalar::Lights<float>> lights_;
    std::size_t point_ = 0;
};

}  // namespace

Combination::Combination(std::string name, CombinationPlan plan, Techniques parts,
    std::shared_ptr<const Technique> target, const SourceLocation& weights_at, const SourceLocation& probabilities_at,
    std::shared_ptr<const SamplerAdapter> weigh)
    : name_(std::move(name)),
      plan_(std::move(plan)),
      parts_(std::move(parts)),
      target_(std::move(target)),
      weights_(plan_.weights, parts_.size(), plan_.kind == CombinationKind::mis, weights_at),
      probabilities_(plan_.probabilities, parts_.size(), false, probabilities_at),
      weigh_(std::move(weigh)) {
    if (plan_.kind == CombinationKind::mixture) mixture_ = mixture_technique(parts_, weights_);
    if (!plan_.target) plan_.target = target_product;
    if (plan_.samples.size() == 1) plan_.samples.assign(parts_.size(), plan_.samples[0]);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        built_in_.push_back(parts_[k]->built_in());
        repeats_.push_back(samples_of(k));
    }
}

bool Combination::runs_in_kernels() const {
    return plan_.kind != CombinationKind::ris && !weigh_ && parts_.size() <= most_parts &&
        std::ranges::all_of(built_in_, [](int k) { return k >= 0; });
}

CombinationCall Combination::kernel_call(const PixelNumbers* numbers) const {
    CombinationCall out;
    out.combination = this;
    out.form = mixture_              ? CombinationCall::Form::mixture
        : plan_.draw == MisDraw::one ? CombinationCall::Form::one
                                     : CombinationCall::Form::every;
    out.power = plan_.heuristic == MisHeuristic::power;
    out.has_weights = !plan_.weights.empty();
    out.samplers = parts_.size();
    out.sampler = built_in_.data();
    out.repeats = repeats_.data();
    out.numbers = numbers;
    return out;
}

void CombinationCall::shares(const ShadingPoints& points, std::size_t point, double* out) const {
    combination->shares_at(points, point, std::span(out, samplers));
}

double CombinationCall::weight(
    const ShadingPoints& points, std::size_t point, std::size_t k, float cos_i, const double* p) const {
    FormulaInputs in = formula_inputs(points, run_of(points, point, 0));
    in.cos_i = double(cos_i);
    return combination->mis_weight(k, in, std::span(p, samplers));
}

void CombinationCall::read_numbers(const std::uint32_t* pixel, std::size_t count, std::uint64_t sample,
    std::uint32_t block, float* x, float* y) const {
    for (std::size_t l = 0; l < count; ++l) {
        const Vec2<float> u = (*numbers)(pixel[l], sample, block);
        x[l] = as_float(double(u.x));
        y[l] = as_float(double(u.y));
    }
}

void Combination::shares_at(const ShadingPoints& points, std::size_t point, std::span<double> out) const {
    const WeightList& list = mixture_ ? weights_ : probabilities_;
    list.evaluate(formula_inputs(points, run_of(points, point, 0)), out);
}

void Combination::evaluate(const SamplerQuery& /*query*/, const SamplerAnswers& /*out*/) const {
    ensure(false, "a combination is estimated at shading points");
}

std::uint64_t Combination::samples_of(std::size_t k) const { return plan_.samples.empty() ? 1 : plan_.samples[k]; }

SampleCost Combination::cost() const {
    SampleCost out;
    const std::uint64_t others = parts_.size() - 1;
    if (plan_.kind == CombinationKind::ris) {
        const std::uint64_t m = *plan_.candidates;
        out.f = target_ ? 1 : m;
        out.densities = m * (others + (target_ ? 1 : 0));
    } else if (plan_.kind == CombinationKind::mis && plan_.draw != MisDraw::one) {
        out.directions = 0;
        for (std::size_t k = 0; k < parts_.size(); ++k) out.directions += samples_of(k);
        out.f = out.directions;
        out.densities = out.directions * others;
    } else {
        out.densities = others;
    }
    return out;
}

std::vector<double> Combination::shares(const FormulaInputs& in) const {
    std::vector<double> c(parts_.size());
    if (plan_.draw == MisDraw::one) probabilities_.evaluate(in, c);
    else
        for (std::size_t k = 0; k < c.size(); ++k) c[k] = static_cast<double>(samples_of(k));
    return c;
}

double Combination::mis_weight(std::size_t k, FormulaInputs in, std::span<const double> p) const {
    if (std::ranges::any_of(p, [](double v) { return !(v >= 0); })) return std::numeric_limits<double>::quiet_NaN();
    if (!(p[k] > 0)) return 0;
    if (!plan_.weights.empty()) {
        std::vector<double> w(parts_.size());
        in.p = p;
        weights_.evaluate(in, w);
        return w[k];
    }
    // Relative to p[k]: a large density does not overflow.
    const std::vector<double> share = shares(in);
    double sum = 0;
    for (std::size_t j = 0; j < p.size(); ++j) {
        const double ratio = j == k ? 1 : share[j] * p[j] / (share[k] * p[k]);
        sum += plan_.heuristic == MisHeuristic::power ? ratio * ratio : ratio;
    }
    return share[k] > 0 ? 1 / sum : 0;
}

std::vector<double> Combination::mis_weights(const PointRows& rows, std::span<const std::size_t> k,
    std::span<const Vec3<float>> wi, const std::vector<std::vector<double>>& p) const {
    const std::size_t samplers = parts_.size();
    std::vector<double> out(wi.size()), row_densities(samplers), densities;
    std::vector<Vec3<float>> directions;
    std::vector<std::size_t> row_indices;
    std::vector<PointRun> runs;
    std::size_t row = 0;
    for (const PointRun& run : rows.runs) {
        FormulaInputs in = formula_inputs(rows.points, run);
        runs.push_back({run.point, run.wo, 0});
        for (std::size_t i = 0; i < run.rows; ++i, ++row) {
            for (std::size_t j = 0; j < samplers; ++j) row_densities[j] = p[j][row];
            const bool calls = weigh_ && row_densities[k[row]] > 0 &&
                std::ranges::all_of(row_densities, [](double v) { return v >= 0; });
            in.cos_i = double(wi[row].z);
            if (!calls) {
                out[row] = mis_weight(k[row], in, row_densities);
                continue;
            }
            row_indices.push_back(row);
            directions.push_back(wi[row]);
            ++runs.back().rows;
            densities.insert(densities.end(), row_densities.begin(), row_densities.end());
        }
        if (runs.back().rows == 0) runs.pop_back();
    }
    if (row_indices.empty()) return out;
    std::vector<double> w(densities.size());
    external_weights(*weigh_, {rows.points, runs}, directions, densities, w);
    for (std::size_t i = 0; i < row_indices.size(); ++i) out[row_indices[i]] = w[i * samplers + k[row_indices[i]]];
    return out;
}

void Combination::sample(const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const {
    if (plan_.kind == CombinationKind::ris) sample_resampled(point_rows, u, out);
    else if (plan_.kind == CombinationKind::mis && plan_.draw != MisDraw::one) sample_every(point_rows, u, out);
    else if (mixture_) sample_mixture(point_rows, u, out);
    else sample_one(point_rows, u, out);
}

void Combination::sample_every(
    const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const {
    const std::size_t rows = point_rows.count(), count = directions();
    std::vector<PointDraw> draws(rows);
    std::vector<Vec3<float>> wi(rows);
    std::vector<std::vector<double>> p(parts_.size(), std::vector<double>(rows));
    std::size_t next = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k)
        for (std::size_t repeat = 0; repeat < samples_of(k); ++repeat, ++next) {
            parts_[k]->draw(point_rows,
                numbers_of(point_rows, u, k, repeat, static_cast<std::size_t>(parts_[k]->numbers())), draws);
            for (std::size_t i = 0; i < rows; ++i) {
                wi[i] = draws[i].wi;
                p[k][i] = draws[i].pdf;
            }
            for (std::size_t j = 0; j < parts_.size(); ++j)
                if (j != k) parts_[j]->density(point_rows, wi, p[j]);
            const std::vector<double> w = mis_weights(point_rows, std::vector<std::size_t>(rows, k), wi, p);
            for (std::size_t row = 0; row < rows; ++row)
                out[row * count + next] = draws[row].pdf == 0
                    ? direction_of(draws[row], 0, 0)
                    : direction_of(draws[row], draws[row].pdf, w[row] / static_cast<double>(samples_of(k)));
        }
}

void Combination::sample_mixture(
    const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const {
    std::vector<PointDraw> draws(out.size());
    mixture_->draw(point_rows, numbers_of(point_rows, u, 0, 0, static_cast<std::size_t>(mixture_->numbers())), draws);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = direction_of(draws[i], draws[i].pdf, draws[i].pdf == 0 ? 0 : 1);
}

void Combination::sample_one(
    const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const {
    const auto numbers = static_cast<std::size_t>(most_numbers(parts_));
    const std::vector<double> c = weights_at(point_rows, probabilities_),
                              random_numbers = numbers_of(point_rows, u, 0, 0, numbers);
    const Choices choices = choose(point_rows, random_numbers, numbers, c, parts_.size());
    std::vector<PointDraw> draws(choices.part.size());
    std::vector<std::vector<double>> p;
    draw_chosen(parts_, point_rows, random_numbers, numbers, choices, draws, p);
    std::vector<Vec3<float>> wi;
    for (const PointDraw& draw : draws) wi.push_back(draw.wi);
    const std::vector<double> w = mis_weights(point_rows, choices.part, wi, p);
    std::size_t row = 0;
    for (std::size_t r = 0; r < point_rows.runs.size(); ++r)
        for (std::size_t i = 0; i < point_rows.runs[r].rows; ++i, ++row)
            out[row] = draws[row].pdf == 0
                ? direction_of(draws[row], 0, 0)
                : direction_of(draws[row], draws[row].pdf, w[row] / c[r * parts_.size() + choices.part[row]]);
}

void Combination::sample_resampled(
    const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const {
    const std::size_t rows = point_rows.count(), m = static_cast<std::size_t>(*plan_.candidates),
                      samplers = parts_.size();
    const auto candidates_of = [&](std::size_t k) { return double((m + samplers - 1 - k) / samplers); };
    Products product(point_rows.points, *plan_.target == target_product);
    std::vector<PointDraw> draws(rows), chosen_draws(rows);
    std::vector<Vec3<float>> wi(rows);
    std::vector<double> p(rows), density(rows), target(rows), sum(rows), chosen_target(rows), selector(rows);
    std::size_t row = 0;
    for (std::size_t r = 0; r < point_rows.runs.size(); ++r)
        for (std::size_t i = 0; i < point_rows.runs[r].rows; ++i) selector[row++] = double(u(r, i, selection).x);
    for (std::size_t c = 0; c < m; ++c) {
        const std::size_t k = c % samplers;
        parts_[k]->draw(point_rows,
            numbers_of(point_rows, u, k, c / samplers, static_cast<std::size_t>(parts_[k]->numbers())), draws);
        for (std::size_t i = 0; i < rows; ++i) {
            wi[i] = draws[i].wi;
            density[i] = candidates_of(k) * draws[i].pdf;
        }
        for (std::size_t j = 0; j < samplers; ++j) {
            if (j == k) continue;
            parts_[j]->density(point_rows, wi, p);
            for (std::size_t i = 0; i < rows; ++i) density[i] += candidates_of(j) * p[i];
        }
        if (target_) target_->density(point_rows, wi, target);
        row = 0;
        for (const PointRun& run : point_rows.runs)
            for (std::size_t i = 0; i < run.rows; ++i, ++row) {
                if (draws[row].pdf == 0) continue;
                if (!target_) target[row] = product(run, draws[row]);
                if (target_ && !(wi[row].z > 0)) target[row] = 0;
                // The chosen candidate is replaced with probability weight / sum; the number that decides is stretched
                // back to (0, 1).
                const double weight = target[row] / density[row];
                if (weight == 0) continue;
                sum[row] += weight;
                const double share = weight / sum[row];
                if (selector[row] < share || !(share < 1)) {
                    chosen_draws[row] = draws[row];
                    chosen_target[row] = target[row];
                    selector[row] = selector[row] / share;
                } else {
                    selector[row] = (selector[row] - share) / (1 - share);
                }
                selector[row] = std::clamp(selector[row], 0x1p-53, 1 - 0x1p-53);
            }
    }
    for (row = 0; row < rows; ++row)
        out[row] = sum[row] == 0 ? direction_of(chosen_draws[row], 0, 0)
                                 : direction_of(chosen_draws[row], chosen_target[row] / sum[row], 1);
}

std::shared_ptr<const Technique> Combination::technique() const {
    if (mixture_) return mixture_;
    const bool balance = plan_.weights.empty() && !weigh_ && plan_.heuristic != MisHeuristic::power;
    if (plan_.kind == CombinationKind::mis && plan_.draw == MisDraw::one && balance)
        return mixture_technique(parts_, probabilities_);
    return nullptr;
}

// ---- Directions of many shading points are made in one batch and passed to the scalar kernel one point after another.

namespace {

/// The arm of the kernel: hands out the directions of one sample after another.
template <class F> struct DirectionsOfSamples {
    static constexpr bool many_directions = true;
    mutable const WeightedDirection* next;
    std::size_t count;
};

}  // namespace

void estimate_combination(const Combination& combination, const KernelCall& call, const std::string& isa,
    const PixelNumbers* numbers, bool in_kernels) {
    if (in_kernels && combination.runs_in_kernels())
        return kernels_for(isa).of_combinations[call.shading_points->around ? 1 : 0](
            call, combination.kernel_call(numbers));
    const ShadingPoints& points = *call.shading_points;
    const std::uint64_t n = call.sample_counts.back();
    const std::size_t count = combination.directions();
    const PointKernel<DirectionsOfSamples<float>> kernel = point_kernel<DirectionsOfSamples<float>>(points);
    const std::uint64_t longest = std::max<std::uint64_t>(1, batch_rows / count);
    const std::uint64_t points_a_batch = std::max<std::uint64_t>(1, longest / n);
    std::vector<PointRun> runs;
    std::vector<WeightedDirection> part;
    std::vector<std::vector<WeightedDirection>> directions(points_a_batch);
    for (std::size_t i = 0; i < points.count; i += points_a_batch) {
        const std::size_t end = std::min<std::size_t>(points.count, i + points_a_batch);
        for (auto& of_point : directions) of_point.clear();
        for (std::uint64_t first = 0; first < n; first += longest) {
            if (call.stop && call.stop->load(std::memory_order_relaxed)) return;
            const auto rows = static_cast<std::size_t>(std::min(longest, n - first));
            runs.clear();
            for (std::size_t index = i; index < end; ++index) runs.push_back(run_of(points, index, rows));
            part.resize(runs.size() * rows * count);
            combination.sample(
                {points, runs},
                [&](std::size_t run, std::size_t row, std::uint32_t block) {
                    const std::uint32_t pixel = points.pixel[runs[run].point];
                    return numbers ? (*numbers)(pixel, first + row, block)
                                   : crescent::draw(call.seed, pixel, first + row, block);
                },
                part);
            for (std::size_t r = 0; r < runs.size(); ++r) {
                const auto begin = part.begin() + static_cast<std::ptrdiff_t>(r * rows * count);
                directions[r].insert(directions[r].end(), begin, begin + static_cast<std::ptrdiff_t>(rows * count));
            }
        }
        for (std::size_t index = i; index < end; ++index) kernel(call, index, {directions[index - i].data(), count});
    }
}

}  // namespace crescent
