// The parts of the module `crescent._crescent`, each in its own file.
#pragma once

#include <nanobind/nanobind.h>

namespace crescent::python {

void add_checking(nanobind::module_& m);     // checking.cpp
void add_experiments(nanobind::module_& m);  // experiments.cpp
void add_domains(nanobind::module_& m);      // domains.cpp
void add_arms(nanobind::module_& m);         // arms.cpp
void add_parts(nanobind::module_& m);        // parts.cpp

}  // namespace crescent::python
