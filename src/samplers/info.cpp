// The table is made from the types of samplers/all.h at first use: name, documentation, techniques and theory.
#include "samplers/info.h"

#include "math/functions.h"
#include "samplers/all.h"

namespace crescent {

namespace {

template <template <class> class A> constexpr SamplerInfo info_of() {
    static_assert(A<float>::manual.label.find(A<float>::name) != std::string_view::npos,
        "an arm goes by one name everywhere: its label holds it");
    SamplerInfo out{A<float>::manual, A<float>::name};
    if constexpr (requires { A<float>::techniques; }) out.techniques = A<float>::techniques;
    if constexpr (requires { A<float>::theory; }) out.theory = A<float>::theory;
    if (out.density.empty()) out.density = out.formula;
    return out;
}

}  // namespace

std::string power_underflows(const CasePoint& point, double smallest_cos) {
    const bool underflows =
        point.rho_d > 0 && point.s * math::log(smallest_cos) < -1074 * math::log(2.0) + math::log(point.s + 1);
    return underflows
        ? "the lobe's power is less than the smallest number there is where Lambert is not 0: p is 0 in the arm's "
          "own arithmetic"
        : "";
}

const std::vector<SamplerInfo>& sampler_infos() {
    static const std::vector<SamplerInfo> list = [] {
        std::vector<SamplerInfo> infos;
        for_each_sampler(Samplers{}, [&]<template <class> class A>() { infos.push_back(info_of<A>()); });
        return infos;
    }();
    return list;
}

const SamplerInfo* find_arm_info(std::string_view sampler) {
    for (const SamplerInfo& arm : sampler_infos())
        if (arm.name == sampler) return &arm;
    return nullptr;
}

std::vector<std::string> sampler_names() {
    std::vector<std::string> names;
    for (const SamplerInfo& arm : sampler_infos()) names.emplace_back(arm.name);
    return names;
}

std::uint64_t directions_per_sample(std::string_view sampler) {
    const SamplerInfo* arm = find_arm_info(sampler);
    return arm ? static_cast<std::uint64_t>(arm->techniques) : 1;
}

}  // namespace crescent
