// Keys of tables that say their kind: made from the parameters of each kind of a list (scene/parameter.h).
#pragma once

#include "experiment/schema.h"
#include "scene/parameter.h"

namespace crescent::inline experiment {

/// The type of a key, from that of the member it is stored in.
inline Type type_of(const std::type_identity<double>&, bool) { return Type::number; }
inline Type type_of(const std::type_identity<bool>&, bool) { return Type::flag; }
inline Type type_of(const std::type_identity<Vec3d>&, bool unit) { return unit ? Type::direction : Type::point; }
inline Type type_of(const std::type_identity<std::optional<Rgb>>&, bool) { return Type::color; }

/// The name of the parameter at `index`, counted through all kinds.
template <class... Kind> constexpr std::string_view parameter_name(KindList<Kind...>, std::size_t index) {
    std::string_view name;
    std::size_t k = 0;
    KindList<Kind...>::each_parameter([&](std::string_view, const auto& parameter) {
        if (k++ == index) name = parameter.name;
    });
    return name;
}
template <class... Kind> constexpr std::size_t parameter_count(KindList<Kind...>) {
    return (Kind::parameters().size() + ... + 0);
}

/// Calls f(member) for the parameter of that name, where the kind that `any` holds has it.
template <class Any, class F> void with_parameter(Any& any, std::string_view name, F&& f) {
    std::visit(
        [&](auto& kind) {
            using Kind = std::remove_cvref_t<decltype(kind)>;
            for (const Parameter<Kind>& parameter : Kind::parameters())
                if (parameter.name == name) std::visit([&](auto member) { f(kind.*member); }, parameter.member);
        },
        any);
}

/// The key `kind` of objects whose member Form is one of these kinds.
template <class List, auto Form> constexpr Slot kind_slot = {[](void* object, const Value& value) {
                                                                 using Owner = typename OwnerOf<decltype(Form)>::type;
                                                                 static_cast<Owner*>(object)->*Form =
                                                                     List::make(static_cast<std::size_t>(value.word));
                                                             },
    [](const void* object, Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        value.word = static_cast<int>((static_cast<const Owner*>(object)->*Form).index());
        return true;
    }};

/// The parameter at `index` of whichever kind the object holds.
template <class List, auto Form, std::size_t index>
constexpr Slot parameter_slot = {[](void* object, const Value& value) {
                                     using Owner = typename OwnerOf<decltype(Form)>::type;
                                     with_parameter(static_cast<Owner*>(object)->*Form, parameter_name(List{}, index),
                                         [&](auto& member) { assign(member, value); });
                                 },
    [](const void* object, Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        bool given = false;
        with_parameter(static_cast<const Owner*>(object)->*Form, parameter_name(List{}, index),
            [&](const auto& member) { given = fetch(member, value); });
        return given;
    }};

template <class List, auto Form> Key kind_key() {
    Key key{"kind", Type::word, {}, "", Requirement::required, "", "What it is.", kind_slot<List, Form>};
    for (const std::string_view name : List::names) key.words.emplace_back(name);
    return key;
}

/// A key for every name among the parameters of the kinds; `kinds` says whose it is.
template <class List, auto Form> std::vector<Key> parameter_keys() {
    std::vector<Key> keys;
    std::vector<Slot> slots;
    [&]<std::size_t... index>(std::index_sequence<index...>) { slots = {parameter_slot<List, Form, index>...}; }(
        std::make_index_sequence<parameter_count(List{})>{});
    std::size_t at = 0;
    List::each_parameter([&](std::string_view kind, const auto& p) {
        const Slot& slot = slots[at++];
        const auto same = [&](const Key& key) { return key.name == p.name; };
        if (const auto known = std::find_if(keys.begin(), keys.end(), same); known != keys.end()) {
            known->kinds += " " + std::string(kind);
            return;
        }
        const Type type = std::visit(
            [&]<class Kind, class T>(T Kind::*) { return type_of(std::type_identity<T>{}, p.unit_vector); }, p.member);
        const Requirement need = p.default_value.empty() ? Requirement::required
            : type == Type::flag                         ? Requirement::defaulted
                                                         : Requirement::optional;
        keys.push_back({p.name, type, p.range, p.unit, need, p.default_value, p.means, slot, {}, std::string(kind)});
    });
    return keys;
}

}  // namespace crescent::inline experiment
