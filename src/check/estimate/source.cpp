// Passes batches to the sampler as they are; unusable numbers are counted and replaced by 0.
#include "check/estimate/source.h"

#include <algorithm>
#include <cmath>

#include "check/sources/check_case.h"

namespace crescent::check {

std::span<const Pair> Source::pairs_of(Vec3d from, std::span<const Vec3d> wi) {
    pairs_.resize(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) {
        pairs_[i].wo = from;
        pairs_[i].wi = wi[i];
    }
    evaluations_ += wi.size();
    return pairs_;
}

void Source::note_invalid(InvalidAnswers::Function function, Vec3d wi, double value) {
    ++(function == InvalidAnswers::Function::pdf ? invalid_.pdf : invalid_.f);
    if (invalid_.first != InvalidAnswers::Function::none) return;
    invalid_.first = function;
    invalid_.wi = wi;
    invalid_.value = value;
}

void Source::draw(std::span<const PrimarySample> u, std::span<Draw> out) {
    evaluations_ += u.size();
    adapter.sample(technique, wo, u, out);
}

std::vector<Draw> Source::draw(std::span<const PrimarySample> u) {
    std::vector<Draw> out(u.size());
    draw(u, out);
    return out;
}

namespace {

/// The rows, of each eight, that a stream uses.
std::span<const std::uint32_t> rows_for(const StreamKey& key) {
    static constexpr std::uint32_t pilot[] = {0}, first[] = {1, 3, 5, 7}, second[] = {2, 4, 6};
    if (key.purpose == Purpose::pilot) return pilot;
    return key.confirms() ? std::span<const std::uint32_t>(second) : first;
}

}  // namespace

std::uint32_t Source::available(const StreamKey& key, std::uint32_t limit) const {
    if (!recorded_) return limit;
    const std::span<const std::uint32_t> rows = rows_for(key);
    std::size_t count = recorded_->rows() / 8 * rows.size();
    for (std::uint32_t r : rows) count += r < recorded_->rows() % 8;
    return static_cast<std::uint32_t>(std::min<std::size_t>(limit, count));
}

void Source::draw(const StreamKey& key, std::uint32_t from, std::span<PrimarySample> u, std::span<Draw> out) {
    if (!recorded_) {
        for (std::uint32_t i = 0; i < u.size(); ++i) u[i] = numbers_at(key, from + i, numbers(), resolution());
        return draw(u, out);
    }
    const std::span<const std::uint32_t> rows = rows_for(key);
    for (std::uint32_t i = 0; i < u.size(); ++i) {
        const std::size_t k = from + i, row = k / rows.size() * 8 + rows[k % rows.size()];
        u[i] = recorded_->row_numbers(row);
        out[i] = recorded_->row(row);
    }
}

void Source::density(std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) {
        std::fill(out.begin(), out.end(), 1.0);
        return;
    }
    adapter.exact_pdf(technique, pairs_of(wi), out);
    invalid_.pdf_evaluations += wi.size();
    for (std::size_t i = 0; i < wi.size(); ++i) {
        if (std::isfinite(out[i]) && out[i] >= 0) continue;
        note_invalid(InvalidAnswers::Function::pdf, wi[i], out[i]);
        out[i] = 0;
    }
}

double Source::density(Vec3d wi) {
    double p = 0;
    density({&wi, 1}, {&p, 1});
    return p;
}

void Source::density_from(Vec3d other_wo, std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) return std::fill(out.begin(), out.end(), 1.0);
    adapter.exact_pdf(technique, pairs_of(other_wo, wi), out);
}

void evaluate_below(Source& source, std::span<const Vec3d> w, std::span<double> p) {
    std::vector<std::size_t> rows;
    std::vector<Vec3d> directions;
    for (std::size_t k = 0; k < w.size(); ++k)
        if (!(w[k].z > 0)) {
            rows.push_back(k);
            directions.push_back(w[k]);
        }
    std::vector<double> density(rows.size());
    source.density(directions, density);
    for (std::size_t k = 0; k < rows.size(); ++k) p[rows[k]] = density[k];
}

UsableDraws usable_draws(Source& source, std::span<const Draw> draws, Source* lower_source) {
    UsableDraws out;
    for (std::size_t i = 0; i < draws.size(); ++i)
        if (has_direction(draws[i])) {
            out.row.push_back(i);
            out.w.push_back(draws[i].wi);
        }
    out.p.resize(out.w.size());
    if (lower_source) {
        for (std::size_t k = 0; k < out.w.size(); ++k) out.p[k] = draws[out.row[k]].pdf;
        evaluate_below(*lower_source, out.w, out.p);
    } else {
        source.density(out.w, out.p);
    }
    std::size_t count = 0;
    for (std::size_t k = 0; k < out.w.size(); ++k) {
        if (!is_direction(source.traits, draws[out.row[k]], out.p[k])) continue;
        out.row[count] = out.row[k];
        out.w[count] = out.w[k];
        out.p[count++] = out.p[k];
    }
    out.row.resize(count);
    out.w.resize(count);
    out.p.resize(count);
    return out;
}

bool Source::reached_otherwise(Vec3d wi) {
    for (int t = 0; t < adapter.techniques(); ++t) {
        double p = 0;
        if (t != technique) adapter.exact_pdf(t, pairs_of({&wi, 1}), {&p, 1});
        if (p > 0) return true;
    }
    return false;
}

void Source::mis_weights(std::span<const Vec3d> wi, std::span<double> out) {
    adapter.mis_weight(technique, pairs_of(wi), out);
}

void Source::stated_pdf(std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) return std::fill(out.begin(), out.end(), 1.0);
    adapter.pdf(technique, pairs_of(wi), out);
}

void Source::f_cos(std::span<const Vec3d> wi, std::span<Vec3d> out, bool truth) {
    const std::span<const Pair> pairs = pairs_of(wi);
    if (channels() == 3 && !truth) {
        adapter.f_channels(pairs, out);
    } else {
        std::vector<double> y(wi.size());
        truth ? adapter.reference_f(pairs, y) : adapter.f(pairs, y);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    invalid_.f_evaluations += wi.size();
    const auto usable = [](double v) { return std::isfinite(v) && v >= 0; };
    for (std::size_t i = 0; i < wi.size(); ++i) {
        const Vec3d v = out[i];
        const double c = traits.cosine(wi[i]);
        if (!usable(v.x) || !usable(v.y) || !usable(v.z))
            note_invalid(InvalidAnswers::Function::f, wi[i], !usable(v.x) ? v.x : !usable(v.y) ? v.y : v.z);
        const auto by_channel = [&](double x) { return usable(x) ? x * c : 0; };
        out[i] = {by_channel(v.x), by_channel(v.y), by_channel(v.z)};
    }
}

}  // namespace crescent::check
