// Batches go out as they come; numbers that cannot be used are counted and replaced by 0.
#include "check/estimate/source.h"

#include <algorithm>
#include <cmath>

namespace crescent::check {

std::span<const Pair> Source::pairs_of(std::span<const Vec3d> wi) {
    pairs_.resize(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) pairs_[i] = {wo, wi[i]};
    evaluations_ += wi.size();
    return pairs_;
}

double Source::checked(double value, Vec3d at) {
    if (std::isfinite(value) && value >= 0) return value;
    if (invalid_++ == 0) first_invalid_ = at, first_invalid_value_ = value;
    return 0;
}

void Source::draw(std::span<const Numbers> u, std::span<Draw> out) {
    evaluations_ += u.size();
    subject.sample(technique, wo, u, out);
}

void Source::density(std::span<const Vec3d> wi, std::span<double> out) {
    if (!traits.has_pdf) {
        std::fill(out.begin(), out.end(), 1.0);
        return;
    }
    subject.exact_pdf(technique, pairs_of(wi), out);
    for (std::size_t i = 0; i < wi.size(); ++i) out[i] = checked(out[i], wi[i]);
}

double Source::density(Vec3d wi) {
    double p = 0;
    density({&wi, 1}, {&p, 1});
    return p;
}

bool Source::reached_otherwise(Vec3d wi) {
    for (int t = 0; t < subject.techniques(); ++t) {
        double p = 0;
        if (t != technique) subject.exact_pdf(t, pairs_of({&wi, 1}), {&p, 1});
        if (p > 0) return true;
    }
    return false;
}

void Source::stated_pdf(std::span<const Vec3d> wi, std::span<double> out) { subject.pdf(technique, pairs_of(wi), out); }

void Source::f_cos(std::span<const Vec3d> wi, std::span<Vec3d> out, bool truth) {
    const std::span<const Pair> at = pairs_of(wi);
    if (channels() == 3 && !truth) {
        subject.f_channels(at, out);
    } else {
        std::vector<double> y(wi.size());
        truth ? subject.true_f(at, y) : subject.f(at, y);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] = {y[i], y[i], y[i]};
    }
    for (std::size_t i = 0; i < wi.size(); ++i) {
        const double c = std::fabs(wi[i].z);
        out[i] = {checked(out[i].x, wi[i]) * c, checked(out[i].y, wi[i]) * c, checked(out[i].z, wi[i]) * c};
    }
}

}  // namespace crescent::check
