// The inputs of the core from an experiment, as plain numbers and words in one order: written on a machine that reads
// TOML, read on one that has no files. Doubles are hexadecimal, so that no bit is lost.
#pragma once

#include <concepts>
#include <cstdlib>
#include <iostream>
#include <string>

#include "experiment/experiment.h"

namespace crescent::plain {

/// Writes one item after another to a stream.
struct Writer {
    std::ostream& to;
    void item(const double& x) { to << std::hexfloat << x << '\n'; }
    template <class T>
        requires std::integral<T> || std::is_enum_v<T>
    void item(const T& x) {
        to << static_cast<long long>(x) << '\n';
    }
    void item(const std::string& x) { to << x << '\n'; }
    static constexpr bool reads = false;
};

/// Reads the same items from a stream.
struct Reader {
    std::istream& from;
    std::string line() {
        std::string text;
        std::getline(from, text);
        return text;
    }
    void item(double& x) { x = std::strtod(line().c_str(), nullptr); }
    template <class T>
        requires std::integral<T> || std::is_enum_v<T>
    void item(T& x) {
        x = static_cast<T>(std::strtoll(line().c_str(), nullptr, 10));
    }
    void item(std::string& x) { x = line(); }
    static constexpr bool reads = true;
};

template <class V, class T> void visit(V& v, T& x) { v.item(x); }
template <class V> void visit(V& v, Vec3d& x) {
    v.item(x.x);
    v.item(x.y);
    v.item(x.z);
}
template <class V> void visit(V& v, Rgb& x) {
    for (double& c : x) v.item(c);
}
template <class V, class T> void visit(V& v, std::optional<T>& x) {
    bool there = x.has_value();
    v.item(there);
    if (V::reads && there) x.emplace();
    if (there) visit(v, *x);
}
template <class V, class T> void visit(V& v, std::vector<T>& x) {
    std::size_t size = x.size();
    v.item(size);
    x.resize(size);
    for (T& one : x) visit(v, one);
}
template <class V, class... T> void each(V& v, T&... x) { (visit(v, x), ...); }

template <class V, class List> void visit_form(V& v, typename List::Any& form) {
    std::size_t kind = form.index();
    v.item(kind);
    if (V::reads) form = List::make(kind);
    std::visit(
        [&]<class Kind>(Kind& k) {
            for (const Parameter<Kind>& parameter : Kind::parameters())
                std::visit([&](auto member) { visit(v, k.*member); }, parameter.member);
        },
        form);
}
template <class V> void visit(V& v, Shapes::Any& form) { visit_form<V, Shapes>(v, form); }
template <class V> void visit(V& v, LightKinds::Any& form) { visit_form<V, LightKinds>(v, form); }
template <class V> void visit(V& v, Light& l) { each(v, l.name, l.form, l.radiance); }
template <class V> void visit(V& v, Shape& s) {
    Material& m = s.material;
    each(v, s.name, s.form, m.rho_d, m.rho_s, m.brdf, m.s, m.alpha, m.inherits_s, m.specular, s.occludes);
}
template <class V> void visit(V& v, DiskLight& d) {
    each(v, d.name, d.center, d.normal, d.radius, d.radiance, d.two_sided);
}
template <class V> void visit(V& v, ArmPlan& a) { each(v, a.name, a.sampler, a.n); }
template <class V> void visit(V& v, ExponentControl& c) { each(v, c.arm, c.n, c.s, c.shape); }

template <class V> void visit(V& v, Experiment& e) {
    each(v, e.file, e.seed, e.n, e.image.width, e.image.height);
    each(v, e.camera.eye, e.camera.target, e.camera.up, e.camera.vfov_deg, e.shapes, e.disks, e.lights, e.fill, e.arms,
        e.exponent);
    each(v, e.reference.seed, e.reference.lobe_spp, e.reference.disk_spp);
}

}  // namespace crescent::plain
