// Points become directions by the chart of the domain.
#include "check/sources/point_sampler.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <vector>

#include "base/errors.h"
#include "check/sources/random_numbers.h"

namespace crescent {

namespace {

class PointAdapter : public InProcessAdapter {
public:
    PointAdapter(PointSampler sampler, std::string name) : s_(std::move(sampler)), name_(std::move(name)) {
        const std::optional<Domain> domain = Domain::read(s_.domain);
        if (!domain)
            throw InputError(
                {name_, 0, 0}, fmt::format("the domain '{}' is not valid: {}", s_.domain, Domain::refusal(s_.domain)));
        auto chart = std::make_shared<DomainChart>(*domain);
        if (const int limit = most_numbers(*chart); s_.numbers < 1 || s_.numbers > limit)
            throw InputError({name_, 0, 0},
                fmt::format(
                    "takes {} random numbers: expected 1 to {} over the domain {}", s_.numbers, limit, s_.domain));
        traits_.numbers = s_.numbers + static_cast<int>(chart->spreads());
        traits_.wo = Traits::WoDomain::none;
        traits_.has_pdf = static_cast<bool>(s_.pdf);
        traits_.own_random = s_.own_random;
        traits_.bits = 53;
        traits_.domain = chart;
        fit(*chart);
    }
    std::string name() const override { return name_; }
    Traits traits() const override { return traits_; }
    bool serial() const override { return !s_.parallel; }
    bool limited() const override { return false; }
    bool has_f() const override { return static_cast<bool>(s_.f); }

    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        count(u.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            Point x{};
            const double p = drawn(u[i], x);
            out[i] = draw_of_point(chart(), std::span(x).first(coordinates()), p, u[i], s_.numbers);
            if (!traits_.has_pdf && out[i].pdf > 0) out[i].pdf = 1;
        }
    }
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override {
        answer(s_.pdf, "pdf", pairs, out);
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override { answer(s_.f, "f", pairs, out); }

private:
    using Point = std::array<double, Domain::most_coordinates>;
    PointSampler s_;
    std::string name_;
    Traits traits_;

    const DomainChart& chart() const { return *traits_.domain; }
    std::size_t coordinates() const { return chart().domain().coordinates(); }

    double drawn(const PrimarySample& u, Point& x) const {
        std::array<double, PrimarySample::most_numbers> numbers{};
        for (int k = 0; k < s_.numbers; ++k) numbers[static_cast<std::size_t>(k)] = u[k];
        try {
            return s_.sample(
                std::span(numbers).first(static_cast<std::size_t>(s_.numbers)), std::span(x).first(coordinates()));
        } catch (const std::exception& e) {
            throw SamplerError(fmt::format("sample threw '{}' at u = ({:.9g})", e.what(),
                fmt::join(std::span(numbers).first(static_cast<std::size_t>(s_.numbers)), ", ")));
        }
    }
    void answer(const PointSampler::Function& call, const char* what, std::span<const Pair> pairs,
        std::span<double> out) const {
        if (!call) return std::fill(out.begin(), out.end(), 1.0);
        count(pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            Point x{};
            const std::span<double> point = std::span(x).first(coordinates());
            const double factor = chart().point(pairs[i].wi, point);
            try {
                out[i] = factor > 0 ? factor * call(point) : 0;
            } catch (const std::exception& e) {
                throw SamplerError(fmt::format("{} threw '{}' at {}", what, e.what(), chart().domain().text(point)));
            }
        }
    }
    void fit(DomainChart& chart) const {
        if (!chart.domain().is_infinite()) return;
        std::vector<double> points;
        for (const PrimarySample& u : numbers_of_chart(s_.numbers)) {
            Point x{};
            if (drawn(u, x) > 0)
                points.insert(points.end(), x.begin(), x.begin() + static_cast<std::ptrdiff_t>(coordinates()));
        }
        chart.fit(points);
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> adapter_of(const PointSampler& sampler, const std::string& name) {
    return std::make_shared<PointAdapter>(sampler, name);
}

}  // namespace crescent
