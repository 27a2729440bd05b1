// What a program says of itself: `hello 1 NAME`, or `hello 2 NAME [KEY=VALUE]...`; docs/verdicts.md has the keys.
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

/// "" where the answer could be read; else what was got in place of it.
std::string read_greeting(std::string_view answer, Greeting& out);

}  // namespace crescent::inline subjects
