// The C interface between crescent's core, compiled to WebAssembly, and the page. One bench an instance: the experiment
// that was opened last.
//
// A call that answers in words takes its request as JSON in request_buffer(size) and leaves its answer, JSON or text,
// at response_data(), response_size(). A call that answers in numbers leaves planes of 4 bytes a pixel at the address
// it returns; they stand until the next call. Boxes are [x0, x1) x [y0, y1) in pixels from the bottom-left.
//
// There are no exceptions in WebAssembly as Debian's libraries have it: what throws calls `api.failed` of the page
// with its kind and its message, and never returns. The page drops such an instance and makes another one.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crescent/portable.h"

#define CRESCENT_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto crescent_##name

namespace crescent::web {

using nlohmann::ordered_json;

/// The request in request_buffer(), and the answer.
ordered_json request();
void respond(std::string text);
void respond(const ordered_json& answer);

/// Bytes for the page, kept until the next call.
template <class T> std::vector<T>& scratch() {
    static std::vector<T> all;
    return all;
}

/// A sample count that is being filled in, tile by tile.
struct Slot {
    RunKey key;
    Film film;
};

/// What was opened.
struct Bench {
    Experiment experiment;
    Scene scene;
    ShapeMap shapes;
    std::vector<Slot> slots;
    /// What primary rays met, by box, for the arms and sample counts that follow; and of the last box that there was no
    /// room for.
    std::map<std::array<int, 4>, std::vector<ShadingPoints>> shading_points;
    std::size_t points_kept = 0;
    std::array<int, 4> points_last{};
    std::vector<ShadingPoints> last;
    ReferenceFilm reference;
    std::unique_ptr<PixelQuadrature> quadrature;

    explicit Bench(Experiment opened) : experiment(std::move(opened)), scene(experiment) {}
    std::size_t width() const { return static_cast<std::size_t>(experiment.image.width); }
    std::size_t pixels() const { return width() * static_cast<std::size_t>(experiment.image.height); }
};
/// Throws Bug where nothing is open.
Bench& bench();
Slot& slot(int index);

/// NaN and infinities have no JSON: they are told by name, as in metrics.json.
ordered_json json_number(double x);
/// The arm `name` of the experiment; throws InputError where there is none.
const ArmPlan& arm_of(const std::string& name);

}  // namespace crescent::web
