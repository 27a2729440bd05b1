#include "estimator/kernel.h"

#include "arms/all.h"
#include "base/errors.h"

namespace crescent {

KernelTable scalar_kernels();
KernelTable sse4_kernels();
KernelTable avx2_kernels();
KernelTable avx512_kernels();

void Moments::resize(std::size_t sites, std::size_t disks) {
    for (auto* sums : {&g, &g_lobe, &square}) sums->resize(sites);
    for (auto* sums : {&disk_g, &disk_g_lobe}) {
        sums->resize(disks);
        for (std::vector<double>& of_disk : *sums) of_disk.resize(sites);
    }
    largest.resize(sites);
    for (auto* counts : {&horizon, &hits, &bad}) counts->resize(sites);
}

std::vector<std::string> isas() {
    std::vector<std::string> out = {"scalar"};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("sse4.2")) out.push_back("sse4");
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("f16c")) out.push_back("avx2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
        out.push_back("avx512");
#endif
    return out;
}

namespace {

// Each maker is compiled for its own instruction set, so only those that this machine has may be called.
std::vector<KernelTable> tables_here() {
    std::vector<KernelTable> tables;
    for (const std::string& isa : isas()) {
        tables.push_back(isa == "avx512" ? avx512_kernels() : isa == "avx2" ? avx2_kernels() : isa == "sse4" ? sse4_kernels() : scalar_kernels());
    }
    return tables;
}

}  // namespace

const KernelTable& kernels_for(const std::string& isa) {
    static const std::vector<KernelTable> tables = tables_here();
    const std::string wanted = isa.empty() ? std::string(tables.back().isa) : isa;
    for (const KernelTable& table : tables) {
        if (table.isa == wanted) return table;
    }
    for (const char* known : {"scalar", "sse4", "avx2", "avx512"}) {
        if (wanted == known) throw InputError({"--isa", 0, 0}, "this machine has no " + wanted + "; it has " + std::string(tables.back().isa) + " at best");
    }
    const std::string near = nearest(wanted, {"scalar", "sse4", "avx2", "avx512"});
    throw InputError({"--isa", 0, 0}, "expected scalar, sse4, avx2 or avx512, not '" + wanted + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

int arm_index(std::string_view sampler) {
    int index = 0, found = -1;
    for_each_arm(Arms{}, [&]<template <class> class A>() {
        if (A<float>::name == sampler) found = index;
        ++index;
    });
    return found;
}

}  // namespace crescent
