// The module `crescent._crescent` of the package `crescent`. Errors keep their kind: InputError and SamplerError become
// ValueError and RuntimeError, OutputError an OSError.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "module.h"
#include "interpreter.h"

namespace {

namespace nb = nanobind;

/// A ValueError with the kind and the path of each mistake as `mistakes`.
void set_value_error(const crescent::InputError& input_error) {
    using Kind = crescent::Diagnostic::Kind;
    nb::list mistakes;
    for (const crescent::Diagnostic& mistake : input_error.diagnostics()) {
        const char* kind = mistake.kind == Kind::unknown_name ? "unknown name"
            : mistake.kind == Kind::misspelt_name             ? "misspelt name"
            : mistake.kind == Kind::box_off_image             ? "box off image"
                                                              : "other";
        mistakes.append(nb::make_tuple(kind, mistake.path));
    }
    const nb::object error = nb::handle(PyExc_ValueError)(input_error.what());
    error.attr("mistakes") = mistakes;
    PyErr_SetObject(PyExc_ValueError, error.ptr());
}

}  // namespace

NB_MODULE(_crescent, m) {
    nb::register_exception_translator([](const std::exception_ptr& p, void*) {
        try {
            std::rethrow_exception(p);
        } catch (const crescent::Interrupted&) {
            PyErr_SetNone(PyExc_KeyboardInterrupt);
        } catch (const crescent::InputError& e) { set_value_error(e); } catch (const crescent::OutputError& e) {
            PyErr_SetString(PyExc_OSError, e.what());
        } catch (const crescent::SamplerError& e) { PyErr_SetString(PyExc_RuntimeError, e.what()); }
    });
    nb::set_leak_warnings(false);  // a callable of the main module may live until the interpreter ends
    m.doc() = "The C++ core of crescent; use the package `crescent`.";
    m.attr("version") = crescent::version();
    m.attr("commit") = crescent::commit();
    crescent::python::prepare_exit(m);
    crescent::python::add_domains(m);
    crescent::python::add_checking(m);
    crescent::python::add_experiments(m);
    crescent::python::add_arms(m);
    crescent::python::add_parts(m);
}
