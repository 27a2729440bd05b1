// The table is made from the types of lobes/all.h at first use. A lobe's kind is its index in that list.
#include "scene/lobes/lobe.h"

#include "base/errors.h"
#include "scene/lobes/all.h"

namespace crescent {

namespace {

template <template <class> class L> LobeInfo info_of(LobeKind kind) {
    LobeInfo out{L<double>::manual, L<double>::name, kind};
    out.exponent = L<double>::exponent;
    out.width = L<double>::width;
    return out;
}

}  // namespace

const std::vector<LobeInfo>& lobe_infos() {
    static const std::vector<LobeInfo> list = [] {
        std::vector<LobeInfo> infos;
        for_each_lobe(Lobes{},
            [&]<template <class> class L>() { infos.push_back(info_of<L>(static_cast<LobeKind>(infos.size()))); });
        return infos;
    }();
    return list;
}

std::vector<std::string> lobe_names() {
    std::vector<std::string> names;
    for (const LobeInfo& lobe : lobe_infos()) names.emplace_back(lobe.name);
    return names;
}

const LobeInfo& lobe_info(LobeKind kind) {
    ensure(kind != LobeKind::none, "a requested lobe exists");
    return lobe_infos().at(static_cast<std::size_t>(kind));
}

LobeKind lobe_named(std::string_view name) {
    if (name.empty()) return LobeKind::none;
    for (const LobeInfo& lobe : lobe_infos())
        if (lobe.name == name) return lobe.kind;
    throw Bug(std::source_location::current(), "no built-in lobe is called " + std::string(name));
}

}  // namespace crescent
