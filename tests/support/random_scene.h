// Random scenes for tests: one surface in view with any lobe of any sharpness, one to three area lights of any size,
// most of them where the surface mirrors the camera's view, and bodies that touch, contain, cut or cover the other
// objects.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "experiment/experiment.h"
#include "math/simd/frame.h"
#include "scene/lobes/all.h"
#include "scene/scene.h"
#include "tests/support/test_scene.h"

namespace crescent::test {

class RandomScene {
public:
    /// `newcomers`: the first area light is a ball or a rectangle of about its size instead of a disk. `far`: a body of
    /// 1e2 to 1e6 m ends in its light, and the scene is up to 1e6 m from (0, 0, 0).
    explicit RandomScene(std::uint32_t seed, bool newcomers = false, bool far = false)
        : next_(seed), newcomers_(newcomers), far_(far) {}

    Experiment operator()() {
        Experiment e;
        e.image = {4, 3};
        e.fill = {between(0, 1), between(0, 1), between(0, 1)};
        floor(e);
        const double up = std::pow(10, between(-1.5, 0));  // the sine of the camera's height
        const Vec3d view = turned(std::sqrt(1 - up * up), up);
        e.camera.eye = between(1, 4) * view;
        e.camera.up = {0, 1, 0.1};
        e.camera.vfov_deg = between(0.5, 15);
        area_lights(e, {-view.x, view.y, -view.z});
        const int bodies = static_cast<int>(between(0, 3.5));
        for (int k = 0; k < bodies; ++k) body(e);
        if (newcomers_) newcomer(e);
        if (far_) {
            large_body(e);
            move(e, scale(1, 1e6) * direction());
        }
        return e;
    }
    std::string what;  // of the last scene, for messages

private:
    double between(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(next_); }
    double scale(double lo, double hi) { return std::exp(between(std::log(lo), std::log(hi))); }
    bool once_in(int n) { return between(0, n) < 1; }
    Vec3d turned(double r, double y) {
        const double phi = between(-pi, pi);
        return {r * std::cos(phi), y, r * std::sin(phi)};
    }
    Vec3d direction() {
        const double y = between(-1, 1);
        return turned(std::sqrt(1 - y * y), y);
    }
    static Vec3d unit(Vec3d v) { return (1 / std::sqrt(dot(v, v))) * v; }

    Material material() {
        Material m;
        const double d = once_in(3) ? 0 : between(0.05, 0.6);
        m.rho_d = {d, d * 0.8, d * 0.5};
        m.s = scale(0.01, 1e6);
        m.alpha = scale(1e-4, 1);
        constexpr int lobes = static_cast<int>(Lobes::count);
        const int lobe = static_cast<int>(between(0, lobes + 1));
        m.rho_s = lobe < lobes ? between(0.1, 0.4) : 0;
        m.brdf = static_cast<LobeKind>(lobe % lobes);
        if (newcomers_ && m.rho_s > 0) m.set_specular({m.rho_s, 0.5 * m.rho_s, 0.1 * m.rho_s});
        what += std::string(lobe < lobes ? lobe_info(m.brdf).name : "lambert") + " s " + std::to_string(*m.s) +
            " alpha " + std::to_string(*m.alpha);
        return m;
    }
    void floor(Experiment& e) {
        what.clear();
        Shape s;
        const bool flat = once_in(2);
        s.name = "floor";
        s.material = material();
        s.occludes = once_in(2);
        if (flat) s.form = shapes::Plane{{}, {0, 1, 0}};
        else {
            const double radius = scale(0.3, 30);
            s.form = shapes::Sphere{{0, -radius, 0}, radius};
        }
        e.shapes.push_back(s);
    }
    void area_lights(Experiment& e, Vec3d mirror) {
        DiskLight l;
        l.name = "lamp";
        l.radius = once_in(4) ? scale(1e-6, 1e-2) : scale(1e-2, 3);
        const double far = scale(0.2, 4);
        const Vec3d way = once_in(4) ? unit(mirror + 0.5 * direction())
                                     : unit(mirror + scale(1e-3, 1) * l.radius / far * direction());
        l.center = far * Vec3d{way.x, std::fabs(way.y), way.z};
        l.normal = once_in(3) ? Vec3d{0, -1, 0} : unit(0.5 * direction() - way);
        l.radiance = {between(1, 20), between(1, 20), between(1, 20)};
        l.two_sided = once_in(3);
        e.disks.push_back(l);
        what += ", lamp r " + std::to_string(l.radius);
        if (!once_in(3)) return;
        l.name = "second";
        const double kind = between(0, 4);
        if (kind < 1)
            l.center = l.center + between(0, 1.5) * l.radius * frame_about(l.normal).t;  // in the first one's plane
        else if (kind < 2) l.center = l.center - between(0, 1) * l.radius * l.normal;    // behind it
        else if (kind < 3) l.normal = direction();                                       // crossing it
        l.radiance = {between(1, 20), between(1, 20), between(1, 20)};                   // else in its place
        e.disks.push_back(l);
        what += " + second";
    }
    void body(Experiment& e) {
        const DiskLight& area_light = e.disks[0];
        const double far = std::sqrt(dot(area_light.center, area_light.center)),
                     size = scale(1e-4, 1) * std::max(area_light.radius, 0.1 * far);
        const Vec3d middle =
            between(0.1, 0.95) * area_light.center + between(0, 1) * (area_light.radius + size) * direction();
        Shape s;
        s.name = "body" + std::to_string(e.shapes.size());
        s.occludes = true;
        s.material.rho_d = {0.3, 0.3, 0.3};
        s.material.s = 10;
        const int kind = static_cast<int>(between(0, 12));
        const auto ball = [&](Vec3d c, double r) { s.form = shapes::Sphere{c, r}; };
        const auto box = [&](Vec3d c, Vec3d half) { s.form = shapes::Box{c - half, c + half}; };
        const auto disk = [&](Vec3d c, Vec3d n, double r) { s.form = shapes::Disk{c, n, r}; };
        const auto quad = [&](Vec3d c, Vec3d u, Vec3d v) { s.form = shapes::Quad{c - 0.5 * (u + v), u, v}; };
        switch (kind) {
            case 0: ball(middle, size); break;
            case 1: box(middle, {size, scale(0.01, 1) * size, size}); break;
            case 2: disk(middle, direction(), size); break;
            case 3: quad(middle, size * direction(), size * direction()); break;
            case 4: ball({0, 0, 0}, scale(0.1, 10)); break;  // round the surface, and more
            case 5: box({0.01, 0.02, 0}, scale(0.1, 10) * Vec3d{1, 1, 1}); break;
            case 6:
                ball(area_light.center, scale(0.3, 3) * area_light.radius);
                break;  // round the area light, or in it
            case 7: box(area_light.center + Vec3d{0, between(-1, 1), 0} * size, {size, size, size}); break;
            case 8:
                box(area_light.center + Vec3d{0, size, 0}, {2 * size, size, 2 * size});
                break;  // its lower face at the area light
            case 9:
                disk({0, 0, 0}, {0, 1, 0}, scale(0.001, 1));
                s.material = e.shapes[0].material;
                break;  // a mat
            case 10: quad({0, 0, 0}, scale(0.01, 1) * turned(1, 0), scale(0.01, 1) * turned(1, 0)); break;
            default:
                quad(area_light.center, 3 * size * frame_about(area_light.normal).t,
                    size * frame_about(area_light.normal).b);
                break;  // in the area light's plane
        }
        e.shapes.push_back(s);
        what += ", body " + std::to_string(kind) + " size " + std::to_string(size);
    }

    void newcomer(Experiment& e) {
        const DiskLight area_light = e.disks[0];
        e.disks.erase(e.disks.begin());
        Light light = area_light.light();
        if (once_in(2)) {
            light.form = lights::Sphere{area_light.center,
                std::min(area_light.radius, 0.9 * std::sqrt(dot(area_light.center, area_light.center)))};
        } else {
            const Frame<double> frame = frame_about(area_light.normal);
            const Vec3d u = 2 * area_light.radius * frame.t, v = scale(0.1, 2) * area_light.radius * frame.b;
            light.form = lights::Rectangle{area_light.center - 0.5 * (u + v), u, v, area_light.two_sided};
        }
        e.lights.push_back(light);
        what += ", which is a " + std::string(light.kind());
    }

    /// Its edge, or a side of it, passes between the surface and the area light.
    void large_body(Experiment& e) {
        const Vec3d area_light = std::visit([](const auto& form) { return form.body().middle(); }, e.lights[0].form);
        const double size = scale(1e2, 1e6);
        const Vec3d p = between(0.2, 0.9) * area_light, n = direction();
        const Frame<double> frame = frame_about(n);
        Shape s;
        s.name = "large";
        s.occludes = true;
        s.material.rho_d = {0.3, 0.3, 0.3};
        s.material.s = 10;
        const int kind = static_cast<int>(between(0, 4));
        if (kind == 0) s.form = shapes::Sphere{p - size * n, size};
        if (kind == 1) s.form = shapes::Disk{p - size * frame.t, n, size};
        if (kind == 2) s.form = shapes::Quad{p - between(0.2, 0.8) * size * frame.b, size * frame.t, size * frame.b};
        if (kind == 3) s.form = shapes::Box{p - size * Vec3d{1, 0, 0.5}, p + size * Vec3d{0, 1, 0.5}};
        e.shapes.push_back(s);
        what += ", large body " + std::to_string(kind) + " of " + std::to_string(size) + " m";
    }
    void move(Experiment& e, Vec3d by) {
        shift(e, by);
        what += ", moved by " + std::to_string(std::sqrt(dot(by, by))) + " m";
    }

    std::mt19937_64 next_;
    bool newcomers_, far_;
};

}  // namespace crescent::test
