// What a run returns to Python: texts, films and references as plain data, and the samplers that are callables.
#pragma once

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "callables.h"

namespace crescent::python {

/// Rows bottom-up, [height, width]; the array keeps `owner` alive and shares its memory.
template <class T> nb::object plane(const std::vector<T>& values, int width, int height, nb::handle owner) {
    const std::size_t shape[] = {static_cast<std::size_t>(height), static_cast<std::size_t>(width)};
    return nb::cast(nb::ndarray<nb::numpy, const T>(values.data(), 2, shape, owner));
}

inline constexpr std::pair<const char*, std::vector<float> ReferenceFilm::*> reference_planes[] = {
    {"r", &ReferenceFilm::r}, {"g", &ReferenceFilm::g}, {"b", &ReferenceFilm::b}, {"y", &ReferenceFilm::y},
    {"error", &ReferenceFilm::error}};

inline nb::dict planes_of(const ReferenceFilm& f, nb::handle owner) {
    nb::dict out;
    for (const auto& [name, values] : reference_planes) out[name] = plane(f.*values, f.width, f.height, owner);
    return out;
}

/// Copies a plane of `planes`, and sets the size of its film.
template <class T, class F>
void restore_plane(const nb::dict& planes, const char* name, std::vector<T> F::* values, F& film) {
    using Plane = nb::ndarray<const T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
    const Plane from = nb::cast<Plane>(planes[name]);
    film.height = static_cast<int>(from.shape(0));
    film.width = static_cast<int>(from.shape(1));
    (film.*values).assign(from.data(), from.data() + from.size());
}

using Planes = nb::typed<nb::dict, std::string, nb::any>;
using ReferenceList = nb::typed<nb::list, nb::typed<nb::tuple, double, Planes>>;

/// Returns references as (s, planes); the arrays keep `owner` alive and share its memory.
inline ReferenceList reference_list(const std::vector<ReferenceFilm>& films, nb::handle owner) {
    nb::list out;
    for (const ReferenceFilm& film : films) out.append(nb::make_tuple(film.s, planes_of(film, owner)));
    return out;
}

/// Copies the planes of reference_list().
inline void restore_references(const nb::list& from, std::vector<ReferenceFilm>& to) {
    for (const nb::handle entry : from) {
        const nb::tuple fields = nb::cast<nb::tuple>(entry);
        ReferenceFilm& film = to.emplace_back();
        film.s = nb::cast<double>(fields[0]);
        for (const auto& [name, values] : reference_planes)
            restore_plane(nb::cast<nb::dict>(fields[1]), name, values, film);
    }
}

/// Name, x0, y0, x1, y1 of each region, both ends inclusive, from the bottom-left.
using Boxes = std::vector<std::tuple<std::string, int, int, int, int>>;

using Times = std::vector<std::tuple<std::string, std::uint64_t, double, std::uint64_t, double>>;

/// Name and seconds of wall-clock time of each stage of a run, in their order.
using Stages = std::vector<std::pair<std::string, double>>;

/// The results of a run, as plain data: texts, films and references.
struct RunResult {
    double s = 0;  // the experiment's own
    bool holds = false;
    std::string json, csv, junit;
    Attributes attributes;  // of the films' files
    std::vector<std::pair<RunKey, Film>> films;
    std::vector<ReferenceFilm> references;
    /// (arm, highest N, s, samples, seconds of wall-clock time) of each job, which vary between equal runs.
    Times times;
    int threads = 0;  // with which they were measured
    Boxes boxes;
    Stages stages;
};

RunResult result_of(Measured&& m);

/// The callables as samplers, and whether one of them requires the caller's thread.
struct SamplersOfCallables {
    ExternalSamplers samplers;
    bool serial = false;
};
SamplersOfCallables samplers_of(const CallableArms& callables, Raised& raised);

}  // namespace crescent::python
