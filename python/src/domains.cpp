// The chart of a domain for crescent/_domains.py: points of the domain as directions, and back.
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "module.h"
#include "watched.h"

namespace crescent::python {

namespace {

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Made = nb::ndarray<nb::numpy, double>;

/// An array that Python owns, of `columns` columns; of one dimension for 0 columns.
Made owned(std::vector<double>&& values, std::size_t rows, std::size_t columns) {
    auto* data = new std::vector<double>(std::move(values));
    const nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    if (columns == 0) return Made(data->data(), {rows}, owner);
    return Made(data->data(), {rows, columns}, owner);
}

std::shared_ptr<DomainChart> chart_of(const std::string& text) {
    const std::optional<Domain> domain = Domain::read(text);
    if (!domain) throw nb::value_error(fmt::format("domain is '{}': {}", text, Domain::refusal(text)).c_str());
    return std::make_shared<DomainChart>(*domain);
}

std::pair<Made, Made> directions(const DomainChart& chart, const Rows& points, const Rows& spread) {
    const std::size_t n = points.shape(0), columns = chart.domain().coordinates(), spreads = chart.spreads();
    std::vector<double> w(3 * n), factor(n), image(columns);
    for (std::size_t i = 0; i < n; ++i) {
        const std::span<const double> point(points.data() + i * columns, columns);
        if (!chart.domain().fault(point).empty()) {
            chart.note_outside(point);
            w[3 * i] = w[3 * i + 1] = w[3 * i + 2] = std::nan("");
            factor[i] = 1;
            continue;
        }
        const Vec3d direction = chart.direction(point, {spread.data() + i * spreads, spreads});
        factor[i] = chart.point(direction, image);
        w[3 * i] = direction.x;
        w[3 * i + 1] = direction.y;
        w[3 * i + 2] = direction.z;
    }
    return {owned(std::move(w), n, 3), owned(std::move(factor), n, 0)};
}

std::pair<Made, Made> points(const DomainChart& chart, const Rows& w) {
    const std::size_t n = w.shape(0), columns = chart.domain().coordinates();
    std::vector<double> out(n * columns), factor(n);
    for (std::size_t i = 0; i < n; ++i)
        factor[i] = chart.point({w(i, 0), w(i, 1), w(i, 2)}, std::span(out).subspan(i * columns, columns));
    return {owned(std::move(out), n, columns), owned(std::move(factor), n, 0)};
}

/// The columns of each neighbour of a w_o.
std::vector<std::vector<double>> rows_of_neighbours(double x, double y, double z, int count) {
    std::vector<double> columns;
    add_neighbours(neighbours_of({x, y, z}, count), columns);
    std::vector<std::vector<double>> out;
    for (std::size_t i = 1; i < columns.size(); i += Neighbour::columns)
        out.emplace_back(&columns[i], &columns[i] + Neighbour::columns);
    return out;
}

}  // namespace

void add_domains(nb::module_& m) {
    using namespace nb::literals;
    nb::class_<DomainChart>(m, "DomainChart", "A domain of samplers, mapped to the sphere.")
        .def_prop_ro("name", [](const DomainChart& c) { return c.domain().name(); })
        .def_prop_ro("coordinates", [](const DomainChart& c) { return c.domain().coordinates(); })
        .def_prop_ro("spreads", &DomainChart::spreads)
        .def_prop_ro("most_numbers", [](const DomainChart& c) { return most_numbers(c); })
        .def_prop_ro("discrete", &DomainChart::is_discrete)
        .def_prop_ro("infinite", [](const DomainChart& c) { return c.domain().is_infinite(); })
        .def(
            "fit", [](DomainChart& c, const Rows& rows) { c.fit({rows.data(), rows.size()}); }, "rows"_a)
        .def("directions", &directions, "points"_a, "spread"_a)
        .def("points", &points, "w"_a);
    m.def("domain_chart", &chart_of, "text"_a);
    m.def("neighbours_of", &rows_of_neighbours, "x"_a, "y"_a, "z"_a, "count"_a);
    m.attr("draws_of_chart") = draws_of_chart;
}

}  // namespace crescent::python
