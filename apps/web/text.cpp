// Requests and responses as text, and errors: they are reported to the page, and the call does not return.
#include <cstdlib>
#include <new>
#include <typeinfo>

#include "api.h"

extern "C" {

/// Provided by the page: throws an error of its own out of the call.
[[noreturn]] __attribute__((import_module("api"), import_name("failed"))) void api_failed(
    const char* kind, std::size_t kind_size, const char* text, std::size_t text_size);

void* __cxa_allocate_exception(std::size_t size) { return std::malloc(size); }
void __cxa_free_exception(void* exception) { std::free(exception); }

/// Everything that crescent and the standard library throw derives from std::exception first.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
    const std::string text = static_cast<std::exception*>(thrown)->what();
    const std::string kind = *type == typeid(crescent::InputError) ? "input"
        : *type == typeid(std::bad_alloc)                          ? "memory"
                                                                   : "bug";
    api_failed(kind.data(), kind.size(), text.data(), text.size());
}
}

namespace crescent::web {

namespace {

std::string query, response;

}  // namespace

ordered_json request() { return ordered_json::parse(query); }
void respond(std::string text) { response = std::move(text); }
void respond(const ordered_json& answer) {
    response = answer.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

ordered_json json_number(double x) {
    if (std::isfinite(x)) return x;
    return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
}

CRESCENT_EXPORT(request_buffer)(std::size_t size)->char* {
    query.assign(size, ' ');
    return query.data();
}
CRESCENT_EXPORT(response_data)()->const char* { return response.data(); }
CRESCENT_EXPORT(response_size)()->std::size_t { return response.size(); }

/// Formats text with formulas between dollar signs as HTML with MathML.
CRESCENT_EXPORT(html)()->void { respond(formula::html(request().get<std::string>())); }
/// Formats a number for reading.
CRESCENT_EXPORT(figures)(double x)->void { respond(crescent::figures(x)); }

CRESCENT_EXPORT(version_of)()->void { respond(version() + ", " + commit()); }

}  // namespace crescent::web
