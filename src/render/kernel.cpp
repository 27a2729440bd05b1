// Each instruction set of isas.h is compiled in a file of its own; the machine is queried once for those that it
// supports.
#include "render/kernel.h"

#include "base/errors.h"
#include "base/text.h"
#include "render/isas.h"
#include "samplers/all.h"

namespace crescent::inline render {

KernelTable scalar_kernels();
#define CRESCENT_DECLARE(name, needs) KernelTable name##_kernels();
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
    for (auto* sums : {&around, &around_lobe})
        for (std::vector<double>& of_channel : *sums) of_channel.resize(of_around);
    largest.resize(size);
    for (auto* counts : {&horizon, &hits, &bad}) counts->resize(size);
}

namespace {

struct Isa {
    const char* name;
    bool here;
    KernelTable (*kernels)();  // compiled for this set: called only if the machine has it
};

const std::vector<Isa>& built() {
    static const std::vector<Isa> all = [] {
        std::vector<Isa> list = {{"scalar", true, scalar_kernels}};
#define has CRESCENT_MACHINE_HAS
#define CRESCENT_ADD(name, needs) list.push_back({#name, needs, name##_kernels});
        CRESCENT_ISAS(CRESCENT_ADD)
#undef CRESCENT_ADD
#undef has
        return list;
    }();
    return all;
}

std::vector<KernelTable> tables_here() {
    std::vector<KernelTable> tables;
    for (const Isa& isa : built())
        if (isa.here) tables.push_back(isa.kernels());
    return tables;
}

}  // namespace

std::vector<std::string> isas() {
    std::vector<std::string> out;
    for (const Isa& isa : built())
        if (isa.here) out.push_back(isa.name);
    return out;
}

std::string all_isas() {
    std::string out;
    for (const Isa& isa : built()) out += (out.empty() ? "" : ", ") + std::string(isa.name);
    return out;
}

const KernelTable& kernels_for(const std::string& isa) {
    static const std::vector<KernelTable> tables = tables_here();
    const std::string wanted = isa.empty() ? std::string(tables.back().isa) : isa;
    for (const KernelTable& table : tables)
        if (table.isa == wanted) return table;
    std::vector<std::string> names;
    for (const Isa& known : built()) {
        names.push_back(known.name);
        if (wanted != known.name) continue;
        throw InputError({"--isa", 0, 0},
            "this machine has no " + wanted + "; it has " + std::string(tables.back().isa) + " at best");
    }
    throw InputError({"--isa", 0, 0}, expected_one_of(names, wanted));
}

int arm_index(std::string_view sampler) {
    int index = 0, found = -1;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if (A<float>::name == sampler) found = index;
        ++index;
    });
    return found;
}

}  // namespace crescent::inline render
