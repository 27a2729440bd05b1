// One table: each quantity with its number of columns and their values.
#include "samplers/surface_context.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.h"
#include "scene/lights/all.h"

namespace crescent {

namespace {

constexpr std::array<std::string_view, 7> names = {"s", "alpha", "rho_d", "rho_s", "side", "eta", "lights"};

// Scenes are opaque: w_o is always on the side of the normal, and no light passes through the surface.
constexpr double side = 1, eta = 1;
constexpr std::size_t columns_of_light = 18;

/// 0 disk, 1 sphere, 2 rectangle, and the later kinds of LightKinds.
double kind_number(std::string_view kind) {
    double number = 0, match = 0;
    const auto among = [&]<class... Kind>(KindList<Kind...>) {
        ((Kind::name == kind ? void(match = number) : void(), ++number), ...);
    };
    among(LightKinds{});
    return match;
}

void add_vector(const Vec3<double>& v, std::vector<double>& to) { to.insert(to.end(), {v.x, v.y, v.z}); }

void add_light(const SceneLight& light, const LightAtPoint& geometry, std::vector<double>& to) {
    to.push_back(kind_number(light.kind));
    to.push_back(light.radius);
    to.insert(to.end(), light.radiance.begin(), light.radiance.end());
    for (const Vec3<double>& v : {geometry.center, geometry.normal, geometry.edge_u, geometry.edge_v})
        add_vector(v, to);
    to.push_back(geometry.shines ? 1 : 0);
}

}  // namespace

std::span<const std::string_view> context_names() { return names; }

std::size_t context_columns(std::span<const std::string> uses, std::size_t lights) {
    std::size_t columns = 0;
    for (const std::string& name : uses)
        columns += name == "lights" ? 1 + lights * columns_of_light : name == "rho_d" ? 3 : 1;
    return columns;
}

void add_context(std::span<const std::string> uses, const SurfaceRun& point, std::span<const SceneLight> lights,
    std::span<const LightAtPoint> lights_at, std::vector<double>& to) {
    for (const std::string& name : uses) {
        if (name == "s") to.push_back(point.surface.s);
        else if (name == "alpha") to.push_back(point.surface.alpha);
        else if (name == "rho_s") to.push_back(point.surface.lobe);
        else if (name == "side") to.push_back(side);
        else if (name == "eta") to.push_back(eta);
        else if (name == "rho_d") to.insert(to.end(), point.rho_d.begin(), point.rho_d.end());
        else {
            ensure(name == "lights", "a handshake names known quantities only");
            to.push_back(static_cast<double>(lights.size()));
            for (std::size_t k = 0; k < lights.size(); ++k) add_light(lights[k], lights_at[k], to);
        }
    }
}

bool take_context_names(std::string_view text, std::vector<std::string>& out) {
    out.clear();
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find(',', first), text.size());
        const std::string name(text.substr(first, end - first));
        if (std::ranges::find(names, name) == names.end() || std::ranges::find(out, name) != out.end()) return false;
        out.push_back(name);
        first = end + 1;
    }
    return true;
}

ExampleLight example_light() {
    const Vec3<double> center{0.6, 0.3, 1.8};
    return {{"disk", {10, 10, 10}, 0.4}, {center, center * (-1 / std::sqrt(dot(center, center))), {}, {}, true}};
}

std::vector<double> example_context(std::span<const std::string> uses) {
    const SurfaceRun point{
        .wo = {0, 0, 1}, .surface = {32, 0.24253562503633297, 0.5, 0.5}, .rows = 1, .rho_d = {0.5, 0.5, 0.5}};
    const ExampleLight example = example_light();
    std::vector<double> out;
    add_context(uses, point, {&example.light, 1}, {&example.at, 1}, out);
    return out;
}

}  // namespace crescent
