// An experiment file as a tree of plain nodes in file order, each with its place. The only interface to the TOML
// parser.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace crescent {

struct Member;

/// One TOML value. Tables and arrays keep their members in file order; an array's members have no key.
struct Node {
    enum class Kind { table, array, text, integer, number, flag, date };
    Kind kind = Kind::table;
    SourceLocation location;
    std::vector<Member> members;  // table, array
    std::string text;
    std::int64_t integer = 0;
    double number = 0;  // number; integers too
    bool flag = false;

    bool is_table() const { return kind == Kind::table; }
    bool is_array() const { return kind == Kind::array; }
    const Member* find(std::string_view key) const;
    Member* find(std::string_view key);
};

struct Member {
    std::string key;
    SourceLocation location;  // of the key
    Node value;
};

/// Returns "the text 'red'", "3.5", "a table": what was found, for messages.
std::string describe(const Node& node);

/// Reads TOML; throws InputError if the syntax is wrong or a name is given twice. `file` is in every place.
Node read_toml(std::string_view text, const std::string& file);

}  // namespace crescent
