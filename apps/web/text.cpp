// Requests and answers in words, and what happens to an error: the page is told, and the call does not return.
#include <cstdlib>
#include <new>
#include <typeinfo>

#include "door.h"

extern "C" {

/// The page's: throws an error of its own out of the call.
[[noreturn]] __attribute__((import_module("door"), import_name("failed"))) void door_failed(
    const char* kind, std::size_t kind_size, const char* text, std::size_t text_size);

void* __cxa_allocate_exception(std::size_t size) { return std::malloc(size); }
void __cxa_free_exception(void* exception) { std::free(exception); }

/// Everything that crescent and the standard library throw derives from std::exception first.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
    const std::string text = static_cast<std::exception*>(thrown)->what();
    const std::string kind = *type == typeid(crescent::InputError) ? "input"
        : *type == typeid(std::bad_alloc)                          ? "memory"
                                                                   : "bug";
    door_failed(kind.data(), kind.size(), text.data(), text.size());
}
}

namespace crescent::web {

namespace {

std::string asked, answered;

}  // namespace

ordered_json request() { return ordered_json::parse(asked); }
void say(std::string text) { answered = std::move(text); }
void say(const ordered_json& answer) { answered = answer.dump(-1, ' ', false, ordered_json::error_handler_t::replace); }

ordered_json told(double x) {
    if (std::isfinite(x)) return x;
    return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
}

CRESCENT_EXPORT(room)(std::size_t size)->char* {
    asked.assign(size, ' ');
    return asked.data();
}
CRESCENT_EXPORT(said_at)()->const char* { return answered.data(); }
CRESCENT_EXPORT(said_size)()->std::size_t { return answered.size(); }

/// Words with formulas between dollar signs as HTML with MathML.
CRESCENT_EXPORT(html)()->void { say(formula::html(request().get<std::string>())); }
/// A number for reading.
CRESCENT_EXPORT(figures)(double x)->void { say(crescent::figures(x)); }

CRESCENT_EXPORT(style)()->void { say(std::string(style_sheet)); }
CRESCENT_EXPORT(version_of)()->void { say(version() + ", " + commit()); }

}  // namespace crescent::web
