// The instruction sets: each is compiled in a file of its own; the machine is queried once for those that it
// supports.
#include "render/kernel.h"

#include "base/errors.h"
#include "base/text.h"
#include "render/flip_kernel.h"
#include "samplers/all.h"

// The list of instruction sets with kernels. kernels.cmake reads it too: it makes kernel_NAME.cpp for each set of the
// target processor, with -mFEATURE for every feature that is named here, or an empty table for a set that the build
// leaves out.
//
// isa(name, what a machine must have), in rising order of speed; scalar, which needs nothing, comes before all of them.
// clang-format off: one a line
#define CRESCENT_ISAS_X86(isa)                                                  \
    isa(sse4, has("sse4.2"))                                                    \
    isa(avx2, has("avx2") && has("f16c"))                                       \
    isa(avx512, has("avx512f") && has("avx512vl") && has("avx512dq") && has("avx512bw") && has("avx512cd"))
// clang-format on
#define CRESCENT_ISAS_ARM(isa) isa(neon, true)
#define CRESCENT_ISAS_WASM(isa) isa(wasm128, has("simd128"))

#if defined(CRESCENT_SCALAR)
#define CRESCENT_ISAS(isa)
#elif defined(__x86_64__)
#define CRESCENT_ISAS(isa) CRESCENT_ISAS_X86(isa)
#define CRESCENT_MACHINE_HAS(feature) (__builtin_cpu_supports(feature) != 0)
#elif defined(__aarch64__)
#define CRESCENT_ISAS(isa) CRESCENT_ISAS_ARM(isa)
#elif defined(__wasm_simd128__)
#define CRESCENT_ISAS(isa) CRESCENT_ISAS_WASM(isa)
#else
#define CRESCENT_ISAS(isa)
#endif
#ifndef CRESCENT_MACHINE_HAS
#define CRESCENT_MACHINE_HAS(feature) true  // required by the compiler flags
#endif

namespace crescent {

KernelTable scalar_kernels();
FlipKernel scalar_flip();
#define CRESCENT_DECLARE(name, needs) \
    KernelTable name##_kernels();     \
    FlipKernel name##_flip();
CRESCENT_ISAS(CRESCENT_DECLARE)
#undef CRESCENT_DECLARE

void Moments::resize(const ShadingPoints& shading_points) {
    const std::size_t size = shading_points.pixel.size(), of_around = shading_points.around ? size : 0;
    for (auto* sums : {&g, &g_lobe, &spread}) sums->resize(size);
    for (auto* sums : {&light_g, &light_g_lobe}) {
        sums->resize(shading_points.light_count());
        for (std::vector<double>& of_light : *sums) of_light.resize(size);
    }
    for (auto* sums : {&around_g, &around_g_lobe}) sums->resize(of_around);
    for (auto* sums : {&around_rgb, &around_rgb_lobe})
        for (std::vector<double>& of_channel : *sums) of_channel.resize(of_around);
    largest.resize(size);
    for (auto* counts : {&horizon, &hits, &bad}) counts->resize(size);
}

namespace {

struct Isa {
    const char* name;
    bool is_available;
    KernelTable (*kernels)();  // compiled for this set: called only if the machine has it
};

const std::vector<Isa>& family() {
    static const std::vector<Isa> isas = [] {
        std::vector<Isa> list = {{"scalar", true, scalar_kernels}};
#define has CRESCENT_MACHINE_HAS
#define CRESCENT_ADD(name, needs) list.push_back({#name, needs, name##_kernels});
        CRESCENT_ISAS(CRESCENT_ADD)
#undef CRESCENT_ADD
#undef has
        return list;
    }();
    return isas;
}

std::vector<KernelTable> tables_here() {
    std::vector<KernelTable> tables;
    for (const Isa& isa : family()) {
        if (!isa.is_available) continue;
        const KernelTable table = isa.kernels();
        if (!table.isa.empty()) tables.push_back(table);
    }
    return tables;
}

const std::vector<KernelTable>& tables() {
    static const std::vector<KernelTable> usable = tables_here();
    return usable;
}

}  // namespace

std::vector<std::string> isas() {
    std::vector<std::string> out;
    for (const KernelTable& table : tables()) out.emplace_back(table.isa);
    return out;
}

std::string all_isas() {
    std::string out;
    for (const Isa& isa : family()) out += (out.empty() ? "" : ", ") + std::string(isa.name);
    return out;
}

const KernelTable& kernels_for(const std::string& isa) {
    const std::string_view best = tables().back().isa;
    const std::string_view name = isa.empty() ? best : std::string_view(isa);
    for (const KernelTable& table : tables())
        if (table.isa == name) return table;
    std::vector<std::string> names;
    for (const Isa& candidate : family()) {
        names.emplace_back(candidate.name);
        if (name != candidate.name) continue;
        if (candidate.is_available) throw not_built("--isa " + isa);
        throw InputError({"--isa", 0, 0}, "this machine has no " + isa + "; it has " + std::string(best) + " at best");
    }
    throw InputError({"--isa", 0, 0}, expected_one_of(names, isa));
}

FlipKernel flip_kernel_for(const std::string& isa) {
    const std::string_view kernel_isa = kernels_for(isa).isa;
#define CRESCENT_FIND(name, needs) \
    if (kernel_isa == #name) return name##_flip();
    CRESCENT_ISAS(CRESCENT_FIND)
#undef CRESCENT_FIND
    return scalar_flip();
}

int arm_index(std::string_view sampler) {
    int index = 0, match = -1;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if (A<float>::name == sampler) match = index;
        ++index;
    });
    return match;
}

}  // namespace crescent
