// The built-in samplers and BRDFs as vectorised functions, and the tail of a set of weights, for crescent/arms.py.
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "module.h"
#include "watched.h"

namespace crescent::python {

namespace {

using In = nb::ndarray<const double, nb::shape<-1, 3>, nb::device::cpu>;
using Uniforms = nb::ndarray<const double, nb::shape<-1, 2>, nb::device::cpu>;
using Out = nb::ndarray<nb::numpy, double>;

/// An array that Python owns.
Out made(std::vector<double> values, std::initializer_list<std::size_t> shape) {
    auto* data = new std::vector<double>(std::move(values));
    const nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return Out(data->data(), shape, owner);
}

Vec3d row(const In& a, std::size_t i) { return {a(i, 0), a(i, 1), a(i, 2)}; }

bool same(Vec3d a, Vec3d b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// A built-in sampler on a surface under constant light; one that aims at area lights has no light to aim at.
struct ListedArm {
    std::string name;
    SurfaceSetup surface;

    std::shared_ptr<const SamplerAdapter> at(Vec3d wo) const {
        std::shared_ptr<const SamplerAdapter> out;
        for_each_sampler(Samplers{}, [&]<template <class> class A>() {
            if (A<float>::name == name) out = std::make_shared<BuiltIn<A>>(surface, wo, CaseLighting{});
        });
        return out;
    }
};

ListedArm arm_of(const std::string& name, const std::string& lobe, double s, double alpha, double rho_d, double rho_s) {
    const std::vector<std::string> names = sampler_names(), lobes = lobe_names();
    if (std::ranges::find(names, name) == names.end())
        throw nb::value_error(fmt::format("no arm '{}': the list has {}", name, fmt::join(names, ", ")).c_str());
    if (!lobe.empty() && std::ranges::find(lobes, lobe) == lobes.end())
        throw nb::value_error(fmt::format("no BRDF '{}': the list has {}", lobe, fmt::join(lobes, ", ")).c_str());
    ListedArm out{name,
        {.lobe = lobe.empty() ? LobeKind::none : lobe_named(lobe),
            .rho_d = rho_d,
            .rho_s = rho_s,
            .s = s,
            .alpha = alpha}};
    if (out.at({0, 0, 1})->techniques() > 1 || name.starts_with("light"))
        throw nb::value_error(fmt::format("the arm '{}' aims at lights: it has no density of w_i alone", name).c_str());
    return out;
}

/// Calls ask(sampler, i) row by row; a sampler is created again when w_o changes.
template <class Ask> void each_row(const ListedArm& arm, const In& wo, Ask&& ask) {
    std::shared_ptr<const SamplerAdapter> adapter;
    Vec3d aimed{};
    for (std::size_t i = 0; i < wo.shape(0); ++i) {
        if (const Vec3d w = row(wo, i); !adapter || !same(w, aimed)) adapter = arm.at(aimed = w);
        ask(*adapter, i);
    }
}

void alike(std::size_t a, std::size_t b) {
    if (a != b) throw nb::value_error(fmt::format("{} rows and {}: expected equal numbers", a, b).c_str());
}

nb::typed<nb::tuple, Out, Out> sample(const ListedArm& arm, const In& wo, const Uniforms& u) {
    const std::size_t n = wo.shape(0);
    alike(n, u.shape(0));
    std::vector<double> wi(3 * n), pdf(n);
    {
        const Work work_scope;
        each_row(arm, wo, [&](const SamplerAdapter& adapter, std::size_t i) {
            const PrimarySample numbers(u(i, 0), u(i, 1));
            Draw d;
            adapter.sample(0, row(wo, i), {&numbers, 1}, {&d, 1});
            wi[3 * i] = d.wi.x;
            wi[3 * i + 1] = d.wi.y;
            wi[3 * i + 2] = d.wi.z;
            pdf[i] = d.pdf;
        });
    }
    return nb::make_tuple(made(std::move(wi), {n, 3}), made(std::move(pdf), {n}));
}

Out pdf(const ListedArm& arm, const In& wo, const In& wi) {
    const std::size_t n = wo.shape(0);
    alike(n, wi.shape(0));
    std::vector<double> p(n);
    {
        const Work work_scope;
        each_row(arm, wo, [&](const SamplerAdapter& adapter, std::size_t i) {
            const Pair pair{row(wo, i), row(wi, i)};
            adapter.pdf(0, {&pair, 1}, {&p[i], 1});
        });
    }
    return made(std::move(p), {n});
}

Out f(const ListedArm& arm, const In& wo, const In& wi) {
    const std::size_t n = wo.shape(0);
    alike(n, wi.shape(0));
    std::vector<double> value(n);
    for (std::size_t i = 0; i < n; ++i) value[i] = brdf_value(arm.surface, row(wo, i), row(wi, i));
    return made(std::move(value), {n});
}

/// Returns (k, se, exceedances) of the largest of `weights`.
std::optional<std::tuple<double, double, std::uint64_t>> tail_of(
    const nb::ndarray<const double, nb::ndim<1>, nb::device::cpu>& weights) {
    std::vector<double> values(weights.shape(0));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = weights(i);
    const std::size_t count = std::min(tail_length(values.size()) + 1, values.size());
    std::partial_sort(
        values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), values.end(), std::greater<>());
    values.resize(count);
    const std::optional<Tail> tail = fit_tail(std::span<const double>(values));
    if (!tail) return {};
    return std::tuple(tail->k, tail->se, tail->exceedances);
}

}  // namespace

void add_arms(nb::module_& m) {
    using namespace nb::literals;
    nb::class_<ListedArm>(m, "ListedArm", "An arm of the list on a surface.")
        .def(nb::new_(&arm_of), "name"_a, "lobe"_a, "s"_a, "alpha"_a, "rho_d"_a, "rho_s"_a)
        .def("sample", &sample, "wo"_a, "u"_a)
        .def("pdf", &pdf, "wo"_a, "wi"_a)
        .def("f", &f, "wo"_a, "wi"_a);
    m.def("brdf_names", &lobe_names, "The built-in BRDFs' lobes.");
    m.def("tail_of", &tail_of, "weights"_a);
}

}  // namespace crescent::python
