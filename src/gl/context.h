// An OpenGL core context without a window. EGL surfaceless takes a GPU's driver or llvmpipe; OSMesa renders on the CPU.
#pragma once

#include <GL/glcorearb.h>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::gl {

// ---- The entry points of OpenGL that this folder calls, as pointers: the driver's library is opened on demand, so
// that the program runs on machines without one. Core 3.3 except for the last lines, which are null if a driver lacks
// them.

// ---- A shared library that is opened when it is needed and stays open until the process ends, because drivers leave
// threads and handlers behind that need their code.

class Library {
public:
    /// Throws OutputError with the loader's own words; `needed_for` says what goes without it, `packages` what has it.
    Library(const std::string& file, const std::string& needed_for, const std::string& packages);
    /// Null where the library has no such name.
    void* address_of(const char* name) const;
    /// The same as a function; throws OutputError if it is missing.
    template <class Function> Function* function(const char* name) const {
        return reinterpret_cast<Function*>(required(name));
    }

private:
    void* required(const char* name) const;
    std::string file_;
    void* handle_ = nullptr;
};

// clang-format off
#define CRESCENT_GL_CORE(X) \
    X(ACTIVETEXTURE, ActiveTexture) X(ATTACHSHADER, AttachShader) X(BINDFRAMEBUFFER, BindFramebuffer) \
    X(BINDTEXTURE, BindTexture) X(BINDVERTEXARRAY, BindVertexArray) \
    X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(COMPILESHADER, CompileShader) \
    X(CREATEPROGRAM, CreateProgram) X(CREATESHADER, CreateShader) X(DELETEFRAMEBUFFERS, DeleteFramebuffers) \
    X(DELETEPROGRAM, DeleteProgram) X(DELETESHADER, DeleteShader) X(DELETETEXTURES, DeleteTextures) \
    X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(DISABLE, Disable) X(DRAWARRAYS, DrawArrays) \
    X(DRAWBUFFERS, DrawBuffers) X(ENABLE, Enable) X(FINISH, Finish) X(FRAMEBUFFERTEXTURE, FramebufferTexture) \
    X(GENFRAMEBUFFERS, GenFramebuffers) X(GENTEXTURES, GenTextures) X(GENVERTEXARRAYS, GenVertexArrays) \
    X(GETERROR, GetError) X(GETFRAMEBUFFERATTACHMENTPARAMETERIV, GetFramebufferAttachmentParameteriv) \
    X(GETINTEGERV, GetIntegerv) X(GETPROGRAMINFOLOG, GetProgramInfoLog) X(GETPROGRAMIV, GetProgramiv) \
    X(GETSHADERINFOLOG, GetShaderInfoLog) X(GETSHADERIV, GetShaderiv) X(GETSTRING, GetString) \
    X(GETUNIFORMLOCATION, GetUniformLocation) X(ISENABLED, IsEnabled) X(LINKPROGRAM, LinkProgram) \
    X(PIXELSTOREI, PixelStorei) X(READBUFFER, ReadBuffer) X(READPIXELS, ReadPixels) X(SCISSOR, Scissor) \
    X(SHADERSOURCE, ShaderSource) X(TEXIMAGE2D, TexImage2D) X(TEXIMAGE3D, TexImage3D) \
    X(TEXPARAMETERI, TexParameteri) X(TEXSUBIMAGE3D, TexSubImage3D) X(UNIFORM1I, Uniform1i) \
    X(UNIFORM1UI, Uniform1ui) X(UNIFORM2I, Uniform2i) X(UNIFORM3FV, Uniform3fv) X(UNIFORM4FV, Uniform4fv) \
    X(USEPROGRAM, UseProgram) X(VIEWPORT, Viewport)
#define CRESCENT_GL_LATER(X) \
    X(DEBUGMESSAGECALLBACK, DebugMessageCallback) X(GETGRAPHICSRESETSTATUS, GetGraphicsResetStatus)
// clang-format on

struct Functions {
#define CRESCENT_GL_MEMBER(TYPE, name) PFNGL##TYPE##PROC name = nullptr;
    CRESCENT_GL_CORE(CRESCENT_GL_MEMBER)
    CRESCENT_GL_LATER(CRESCENT_GL_MEMBER)
#undef CRESCENT_GL_MEMBER
};

/// Looks up every name; throws OutputError with the first missing one of core 3.3.
Functions functions_from(const std::function<void*(const char*)>& address_of);

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
    void check(const char* step) const;
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

}  // namespace crescent::gl
