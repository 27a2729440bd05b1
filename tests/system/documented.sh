#!/bin/bash
# Every class, function and public member function of the headers that crescent/crescent.h includes, and of the matchers
# for GoogleTest, has a comment. Every file of C and C++ opens with one.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
cd "$CRESCENT_SOURCE/src" || exit 1
look() { python3 "$CRESCENT_SOURCE/tests/system/documented.py" "$@"; }

# It finds each kind without a comment, and none that has one.
cat >"$work/planted.h" <<'END'
namespace planted {

struct Bare {
    int x = 0;
    int twice() const { return 2 * x; }
};

/// Has one.
class Told {
public:
    /// So has this.
    Told(int x);
    Told(const Told&) = default;

    int bare() const;

    int remarked() const;  // in m
    /// Two of a group.
    int first() const;
    int second() const {
        return first();
    }
    int third() const;

private:
    int hidden() const;
};

enum class Kind { one, two };

int lonely(int x,
    int y);

}  // namespace planted
END
look "$work/planted.h" >"$work/found" && die "nothing of what was planted is found"
[ "$(cut -d: -f2 "$work/found" | xargs)" = "3 5 15 29 31" ] || die "found is not what was planted: $(cat "$work/found")"

mapfile -t headers < <(sed -n 's/^#include "\(.*\)"$/\1/p' ../include/crescent/crescent.h)
[ "${#headers[@]}" -gt 25 ] || die "too few headers in crescent/crescent.h: ${headers[*]}"
look "${headers[@]}" check/gtest.h >"$work/found" || die "$(cat "$work/found")"

# unopened FILE...: those whose first line is not a comment.
unopened() { awk 'FNR == 1 && !/^\/[\/*]/ { print FILENAME; nextfile }' "$@"; }
printf '// What it holds.\n#pragma once\n' >"$work/opened.h"
printf '\n// Too late.\n' >"$work/late.h"
[ "$(unopened "$work"/{opened,late,planted}.h | wc -l)" -eq 2 ] || die "files that open without a comment are not found"
cd "$CRESCENT_SOURCE" || exit 1
folders=(include src apps python tests bench examples)
mapfile -t files < <(find "${folders[@]}" -name '*.cpp' -o -name '*.h' -o -name '*.c')
[ "${#files[@]}" -gt 500 ] || die "too few files: ${#files[@]}"
unopened "${files[@]}" >"$work/found"
[ ! -s "$work/found" ] || die "no comment says what these are: $(cat "$work/found")"
