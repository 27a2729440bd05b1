// What a program says of itself: `hello 1 NAME`, or `hello 2 NAME [KEY=VALUE]...`; docs/samplers.md has the keys.
#pragma once

#include <string>
#include <string_view>

#include "subjects/subject.h"

namespace crescent::inline subjects {

struct Greeting {
    int protocol = 1;
    std::string name;
    Traits traits;
    bool hemisphere = false;  // a draw under the horizon is nothing drawn
    bool f_cos = false;       // f comes with |cos|
    bool weight = false, delta = false, blocks = false;
};

/// What was expected of a greeting, and what came in place of it; both empty where it could be read.
struct GreetingFault {
    std::string expected, got;
    explicit operator bool() const { return !got.empty(); }
};
/// Reads the first line that a program answers.
GreetingFault read_greeting(std::string_view answer, Greeting& out);

}  // namespace crescent::inline subjects
