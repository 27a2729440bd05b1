// The lists' macros look up "gl" + name for each entry point, then test each name of core 3.3.
#include <dlfcn.h>

#include "crescent/crescent.h"
#include "functions.h"

namespace crescent::gl {

// ---- Loads libraries by dlopen() with every symbol bound at once and none exported, and dlsym(), without dlclose();
// the reason of a failure is dlerror()'s.

Library::Library(const std::string& file, const std::string& needed_for, const std::string& packages)
    : file_(file), handle_(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_) return;
    const char* why = ::dlerror();
    throw OutputError(file + " cannot be opened, and " + needed_for + " needs it: " + (why ? why : "no reason given") +
        "; install the packages " + packages + " of Debian, or their like");
}

void* Library::address_of(const char* name) const { return ::dlsym(handle_, name); }

void* Library::required(const char* name) const {
    if (void* address = address_of(name)) return address;
    throw OutputError(file_ + " has no " + name);
}

Functions functions_from(const std::function<void*(const char*)>& address_of) {
    Functions f;
#define CRESCENT_GL_LOOK_UP(TYPE, name) f.name = reinterpret_cast<PFNGL##TYPE##PROC>(address_of("gl" #name));
    CRESCENT_GL_CORE(CRESCENT_GL_LOOK_UP)
    CRESCENT_GL_LATER(CRESCENT_GL_LOOK_UP)
#undef CRESCENT_GL_LOOK_UP
#define CRESCENT_GL_REQUIRE(TYPE, name) \
    if (!f.name) throw OutputError("the GL driver has no gl" #name ", which core 3.3 asks for");
    CRESCENT_GL_CORE(CRESCENT_GL_REQUIRE)
#undef CRESCENT_GL_REQUIRE
    return f;
}

}  // namespace crescent::gl
