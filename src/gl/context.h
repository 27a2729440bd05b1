// An OpenGL core context without a window. EGL surfaceless takes a GPU's driver or llvmpipe; OSMesa renders on the CPU.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "crescent/crescent.h"
#include "functions.h"

namespace crescent::gl {

/// The messages of a driver, oldest first; the last few lines are kept.
class DriverLog {
public:
    void add(const std::string& line);
    /// "\nthe driver said: ..." or "".
    std::string text() const;

private:
    mutable std::mutex guard_;  // drivers call back from threads of their own
    std::vector<std::string> lines_;
};

class Context {
public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    virtual std::string kind() const = 0;  // "EGL surfaceless, device 0", "OSMesa"
    virtual void make_current() = 0;
    /// Leaves the thread without a context.
    virtual void release() = 0;
    virtual bool is_current() const = 0;

    const Functions& gl() const { return gl_; }
    std::string version() const { return word(GL_VERSION); }
    std::string renderer() const { return word(GL_RENDERER); }
    /// Returns major and minor version as 3.3, 4.5.
    double version_number() const;
    bool software() const;
    /// Throws OutputError if the context is lost or GL reports an error, with the driver's log.
    void check(const char* after) const;
    const DriverLog& log() const { return log_; }

protected:
    Context() = default;
    /// Must be called once it is current.
    void take_functions(const std::function<void*(const char*)>& address_of);
    DriverLog log_;

private:
    std::string word(GLenum name) const;
    Functions gl_;
};

/// `context`: "", "egl" or "osmesa"; `device`: a number of egl_devices(), -1: a GPU's if one works, else llvmpipe's.
/// Returns it current. Throws InputError for an unknown device, OutputError if none is available.
std::unique_ptr<Context> open_context(const BackendChoice& choice);

std::unique_ptr<Context> open_egl(int device);
std::unique_ptr<Context> open_osmesa();
/// Returns none if EGL is missing.
std::vector<BackendDevice> egl_devices();

}  // namespace crescent::gl
