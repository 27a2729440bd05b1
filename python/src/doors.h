// The parts of the module `crescent._crescent`, each in its own file.
#pragma once

#include <nanobind/nanobind.h>

namespace crescent::python {

void add_judging(nanobind::module_& m);  // judging.cpp

}  // namespace crescent::python
