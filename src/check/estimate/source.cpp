// Passes batches to the sampler as they are; unusable numbers are counted and replaced by 0.
#include "check/estimate/source.h"

#include <algorithm>
#include <cmath>

namespace crescent::check {

std::span<const Pair> Source::pairs_of(Vec3d from, std::span<const Vec3d> wi) {
    pairs_.resize(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) pairs_[i] = {from, wi[i]};
    evaluations_ += wi.size();
    return pairs_;
}

double Source::checked(double value) {
    if (std::isfinite(value) && value >= 0) return value;
    ++invalid_;
    return 0;
}

void Source::draw(std::span<const PrimarySample> u, std::span<Draw> out) {
    evaluations_ += u.size();
    adapter.sample(technique, wo, u, out);
}

namespace {

/// The rows, of each eight, that a stream uses.
std::span<const std::uint32_t> rows_for(const StreamKey& key) {
    static constexpr std::uint32_t pilot[] = {0}, first[] = {1, 3, 5, 7}, second[] = {2, 4, 6};
    if (key.purpose == Purpose::pilot) return pilot;
    return key.confirms() ? std::span<const std::uint32_t>(second) : first;
}

}  // namespace

std::uint32_t Source::available(const StreamKey& key, std::uint32_t wanted) const {
    if (!recorded_) return wanted;
    const std::span<const std::uint32_t> rows = rows_for(key);
    std::size_t count = recorded_->rows() / 8 * rows.size();
    for (std::uint32_t r : rows) count += r < recorded_->rows() % 8;
    return static_cast<std::uint32_t>(std::min<std::size_t>(wanted, count));
}

void Source::draw(const StreamKey& key, std::uint32_t from, std::span<PrimarySample> u, std::span<Draw> out) {
    if (!recorded_) {
        for (std::uint32_t i = 0; i < u.size(); ++i) u[i] = numbers_at(key, from + i, numbers(), single());
        return draw(u, out);
    }
    const std::span<const std::uint32_t> rows = rows_for(key);
    for (std::uint32_t i = 0; i < u.size(); ++i) {
        const std::size_t k = from + i, row = k / rows.size() * 8 + rows[k % rows.size()];
        u[i] = recorded_->row_numbers(row), out[i] = recorded_->row(row);
    }
}

void Source::density(std::span<const Vec3d> wi, std::span<double> out) {
    if (!has_density()) {
        std::fill(out.begin(), out.end(), 1.0);
        return;
    }
    adapter.exact_pdf(technique, pairs_of(wi), out);
    for (std::size_t i = 0; i < wi.size(); ++i) out[i] = checked(out[i]);
}

double Source::density(Vec3d wi) {
    double p = 0;
    density({&wi, 1}, {&p, 1});
    return p;
}

void Source::density_from(Vec3d other_wo, std::span<const Vec3d> wi, std::span<double> out) {
    adapter.exact_pdf(technique, pairs_of(other_wo, wi), out);
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

void Source::stated_pdf(std::span<const Vec3d> wi, std::span<double> out) { adapter.pdf(technique, pairs_of(wi), out); }

void Source::f_cos(std::span<const Vec3d> wi, std::span<Vec3d> out, bool truth) {
    const std::span<const Pair> at = pairs_of(wi);
    if (channels() == 3 && !truth) {
        adapter.f_channels(at, out);
    } else {
        std::vector<double> y(wi.size());
        truth ? adapter.reference_f(at, y) : adapter.f(at, y);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    for (std::size_t i = 0; i < wi.size(); ++i) {
        const double c = std::fabs(wi[i].z);
        out[i] = {checked(out[i].x) * c, checked(out[i].y) * c, checked(out[i].z) * c};
    }
}

}  // namespace crescent::check
