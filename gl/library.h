// A shared library that is opened when it is needed. It stays open until the process ends: drivers leave threads and
// handlers behind that must not lose their code.
#pragma once

#include <string>

namespace crescent::gl {

class Library {
public:
    /// Throws OutputError with the loader's own words; `needed_for` says what goes without it.
    Library(const std::string& file, const std::string& needed_for);
    /// Null where the library has no such name.
    void* address_of(const char* name) const;
    /// The same as a function; throws OutputError where it is not there.
    template <class Function> Function* function(const char* name) const {
        return reinterpret_cast<Function*>(required(name));
    }

private:
    void* required(const char* name) const;
    std::string file_;
    void* handle_ = nullptr;
};

}  // namespace crescent::gl
