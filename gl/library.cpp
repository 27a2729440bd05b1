// dlopen() with every symbol bound at once and none given to others, dlsym(), no dlclose(); the reason is dlerror()'s.
#include "library.h"

#include <dlfcn.h>

#include "crescent.h"

namespace crescent::gl {

Library::Library(const std::string& file, const std::string& needed_for)
    : file_(file), handle_(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_) return;
    const char* why = ::dlerror();
    throw OutputError(file + " cannot be opened, and " + needed_for + " needs it: " + (why ? why : "no reason given"));
}

void* Library::address_of(const char* name) const { return ::dlsym(handle_, name); }

void* Library::required(const char* name) const {
    if (void* address = address_of(name)) return address;
    throw OutputError(file_ + " has no " + name);
}

}  // namespace crescent::gl
