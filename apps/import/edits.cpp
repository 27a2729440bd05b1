// Two corners are at one place if their coordinates are the same doubles.
#include "edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace crescent::importer {

void select(Model& model, const std::string& name) {
    std::set<std::string> model_names;
    const auto has_name = [&](const std::vector<std::string>& names) {
        model_names.insert(names.begin(), names.end());
        return std::ranges::find(names, name) != names.end();
    };
    const auto is_other = [&](Part& part) {
        const std::string& material = model.materials[part.material].name;
        model_names.insert(material);
        if (has_name(part.names) || material == name) return false;
        if (part.copies.empty()) return true;
        std::erase_if(part.copies, [&](const Copy& copy) { return !has_name(copy.names); });
        return part.copies.empty();
    };
    std::erase_if(model.parts, is_other);
    if (!model.parts.empty()) return;
    model_names.erase("");
    constexpr std::size_t most_names = 20;
    std::string words;
    std::size_t count = 0;
    for (const std::string& entry : model_names)
        if (++count <= most_names) words += fmt::format("{}'{}'", words.empty() ? "" : ", ", entry);
    if (count > most_names) words += fmt::format(" or one of {} more", count - most_names);
    throw ModelError(fmt::format("no mesh, node or material has the name '{}'; expected {}", name,
        words.empty() ? "no --select, because none has a name" : words));
}

void turn_and_scale(Model& model, bool z_is_up, double scale) {
    if (!z_is_up && scale == 1) return;
    Transform to;
    if (z_is_up) {
        to.columns[1] = {0, 0, -1};
        to.columns[2] = {0, 1, 0};
    }
    for (Vec3d& column : to.columns) column = scale * column;
    for (Part& part : model.parts) {
        for (Copy& copy : part.copies) copy.to = to.then(copy.to);
        if (!part.copies.empty()) continue;
        for (Vec3d& position : part.positions) position = to.placed(position);
        for (Vec3f& normal : part.normals) normal = narrow((1 / scale) * to.turned(widen(normal)));
    }
    if (!model.camera) return;
    ModelCamera& camera = *model.camera;
    camera.eye = to.placed(camera.eye);
    camera.view = to.turned(camera.view);
    camera.up = to.turned(camera.up);
}

namespace {

Vec3d unit(Vec3d v) {
    const double length = std::sqrt(dot(v, v));
    return length > 0 ? (1 / length) * v : Vec3d{};
}

void smooth_part(Part& part, double least_cosine) {
    const std::size_t count = 3 * part.triangles.size();
    const auto place = [&](std::size_t corner) { return part.positions[part.triangles[corner / 3][corner % 3]]; };
    std::vector<Vec3d> normals, weighted;  // of each triangle; of each corner, times its angle
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
        normals.push_back(unit(cross(place(3 * t + 1) - place(3 * t), place(3 * t + 2) - place(3 * t))));
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d corner = place(3 * t + k);
            const Vec3d a = unit(place(3 * t + (k + 1) % 3) - corner);
            const Vec3d b = unit(place(3 * t + (k + 2) % 3) - corner);
            weighted.push_back(math::acos(std::clamp(dot(a, b), -1.0, 1.0)) * normals.back());
        }
    }
    std::vector<std::size_t> order(count);
    for (std::size_t k = 0; k < count; ++k) order[k] = k;
    const auto key = [&](std::size_t corner) {
        const Vec3d p = place(corner);
        return std::array{p.x, p.y, p.z, static_cast<double>(corner)};
    };
    std::ranges::sort(order, {}, key);
    Part out;  // three corners of each triangle in turn, because each has a normal of its own
    out.material = part.material;
    out.names = part.names;
    out.copies = part.copies;
    out.positions.resize(count);
    out.normals.resize(count);
    if (!part.uv.empty()) out.uv.resize(count);
    const auto same_place = [&](std::size_t a, std::size_t b) {
        const Vec3d p = place(a), q = place(b);
        return p.x == q.x && p.y == q.y && p.z == q.z;
    };
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && same_place(order[begin], order[end])) ++end;
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t corner = order[k];
            Vec3d sum{};
            for (std::size_t j = begin; j < end; ++j)
                if (dot(normals[corner / 3], normals[order[j] / 3]) >= least_cosine) sum = sum + weighted[order[j]];
            out.positions[corner] = place(corner);
            out.normals[corner] = narrow(unit(sum));
            if (!part.uv.empty()) out.uv[corner] = part.uv[part.triangles[corner / 3][corner % 3]];
        }
    }
    for (std::uint32_t t = 0; t < part.triangles.size(); ++t) out.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    part = std::move(out);
}

}  // namespace

void smooth(Model& model, double degrees) {
    const auto is_finite = [](Vec3d v) { return std::isfinite(v.x + v.y + v.z); };
    for (Part& part : model.parts)
        if (part.normals.empty() && std::ranges::all_of(part.positions, is_finite))  // else it is refused later
            smooth_part(part, math::cos(degrees * pi / 180));
}

}  // namespace crescent::importer
