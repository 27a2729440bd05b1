// Shared by the contexts of EGL and OSMesa: entry points, version 3.3 at least, the last 20 errors and messages of high
// severity of the driver. check() tests whether the context is current, then for a reset, then glGetError().
#include <dlfcn.h>
#include <fmt/format.h>

#include "context.h"
#include "crescent/crescent.h"
#include "egl_context.h"
#include "osmesa_context.h"

namespace crescent::gl {

// ---- The lists' macros look up "gl" + name for each entry point, then test each name of core 3.3.

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
    if (!f.name) throw OutputError("the GL driver has no gl" #name ", which core 3.3 requires");
    CRESCENT_GL_CORE(CRESCENT_GL_REQUIRE)
#undef CRESCENT_GL_REQUIRE
    return f;
}

void DriverLog::add(const std::string& line) {
    const std::lock_guard guard(guard_);
    lines_.push_back(line);
    if (lines_.size() > 20) lines_.erase(lines_.begin());
}

std::string DriverLog::text() const {
    const std::lock_guard guard(guard_);
    std::string out;
    for (const std::string& line : lines_) out += "\nthe driver said: " + line;
    return out;
}

namespace {

void APIENTRY keep(
    GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* message, const void* log) {
    if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
    static_cast<DriverLog*>(const_cast<void*>(log))
        ->add(std::string(
            message, length < 0 ? std::char_traits<char>::length(message) : static_cast<std::size_t>(length)));
}

const char* reset_words(GLenum status) {
    switch (status) {
        case GL_GUILTY_CONTEXT_RESET: return "the driver reset the context because of what it drew";
        case GL_INNOCENT_CONTEXT_RESET: return "the driver reset the context because of another program";
        case GL_UNKNOWN_CONTEXT_RESET: return "the driver reset the context";
        default: return nullptr;
    }
}

const char* error_words(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
        default: return "an unknown error";
    }
}

}  // namespace

void Context::take_functions(const std::function<void*(const char*)>& address_of) {
    gl_ = functions_from(address_of);
    if (version_number() < 3.3)
        throw OutputError("the GL back end needs core 3.3; the driver has " + version() + log_.text());
    if (gl_.DebugMessageCallback) {
        gl_.DebugMessageCallback(keep, &log_);
        gl_.Enable(GL_DEBUG_OUTPUT);
    }
    static_cast<void>(gl_.GetError());  // a 3.3 context may lack GL_DEBUG_OUTPUT
}

std::string Context::word(GLenum name) const {
    const GLubyte* text = gl_.GetString(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

double Context::version_number() const {
    GLint major = 0, minor = 0;
    gl_.GetIntegerv(GL_MAJOR_VERSION, &major);
    gl_.GetIntegerv(GL_MINOR_VERSION, &minor);
    return major + 0.1 * minor;
}

bool Context::software() const {
    const std::string name = renderer();
    return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos ||
        name.find("swrast") != std::string::npos;
}

void Context::check(const char* step) const {
    if (!is_current())
        throw OutputError(
            fmt::format("the GL context was lost: after {} it is no longer current{}", step, log_.text()));
    if (gl_.GetGraphicsResetStatus)
        if (const char* words = reset_words(gl_.GetGraphicsResetStatus()))
            throw OutputError(fmt::format("the GL context was lost: after {}, {}{}", step, words, log_.text()));
    if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR)
        throw OutputError(
            fmt::format("GL failed: {} after {} on {}{}", error_words(error), step, renderer(), log_.text()));
}

std::unique_ptr<Context> open_context(const BackendChoice& choice) {
    if (choice.context.empty() || choice.context == "egl") return open_egl(choice.device);
    if (choice.context != "osmesa")
        throw InputError({"--gl-context", 0, 0}, "expected egl or osmesa, not '" + choice.context + "'");
    if (choice.device >= 0)
        throw InputError({"--gl-device", 0, 0}, "expected with --gl-context egl: OSMesa has no devices");
    return open_osmesa();
}

}  // namespace crescent::gl
