// A small run of everything the explainer needs, made once for all tests: a glossy ball before an area light, 96 x 54
// pixels.
#pragma once

#include "data.h"

namespace crescent::explainer::test {

inline Experiment small_experiment() { return load(CRESCENT_SOURCE_DIR "/tests/system/film.toml"); }

inline const Data& small_data() {
    static const Data data = [] {
        ProgressMonitor monitor;
        return collect(small_experiment(), {}, monitor);
    }();
    return data;
}

}  // namespace crescent::explainer::test
