#!/bin/bash
# The packages that ./run installs: every package that dpkg does not list as installed, also on a machine where it knows
# none of them.
. "$(dirname "$0")/common.sh"

root="$work/tree"
mkdir -p "$root/tools" bin
cp "$CRESCENT_SOURCE/tools/setup.sh" "$CRESCENT_SOURCE/tools/packages.txt" "$root/tools/"
. "$root/tools/setup.sh"
PATH="$work/bin:$PATH"

# dpkg_says LINE...: a dpkg-query that prints these.
dpkg_says() {
    printf '#!/bin/sh\ncat <<END\n%s\nEND\n' "$(printf '%s\n' "$@")" >bin/dpkg-query
    chmod +x bin/dpkg-query
}

printf '#!/bin/sh\nexit 1\n' >bin/dpkg-query
chmod +x bin/dpkg-query
[ "$(missing cmake g++ | xargs)" = "cmake g++" ] ||
    die "of two unknown packages these are missing: $(missing cmake g++ | xargs)"
dpkg_says "ii  cmake" "rc  g++"
[ "$(missing cmake g++ ninja-build | xargs)" = "g++ ninja-build" ] ||
    die "missing: $(missing cmake g++ ninja-build | xargs)"
dpkg_says "ii  cmake" "ii  g++"
[ -z "$(missing cmake g++)" ] || die "missing: $(missing cmake g++ | xargs)"

# If clang++-19 is not installed, as outside Debian and Ubuntu, another compiler is used.
mkdir compilers
[ -z "$(PATH=$work/compilers other_compiler release)" ] || die "a compiler that is not there is taken"
for name in g++ clang++; do
    printf '#!/bin/sh\n' >compilers/$name && chmod +x compilers/$name
    [ "$(PATH=$work/compilers other_compiler release)" = "-DCMAKE_CXX_COMPILER=$name" ] || die "$name is not taken"
done
cp compilers/g++ compilers/clang++-19
[ -z "$(PATH=$work/compilers other_compiler release)" ] || die "another compiler than clang++-19 is taken"

# ./run installs what the configuration of the program requires, ./test what that of the tests does.
key() { tr '[:upper:]' '[:lower:]' <<<"$1" | sed -E 's/^lib//; s/-dev$//; s/[^a-z]//g'; }
cd "$CRESCENT_SOURCE" || exit 1
calls='(find_package|pkg_check_modules)\(\w+ (REQUIRED|QUIET)( IMPORTED_TARGET [^)]+)?'
# needs COUNT GROUPS FILE...: each library that these files search is a package of the groups; there are at least COUNT.
needs() {
    local count=$1 groups=$2 found library libraries
    shift 2
    libraries=$(cat "$@" | grep -oE "$calls|crescent_need\(\w+ \w+::|find_library\(\w+" |
        sed -E 's/.*\(//; s/ (REQUIRED|QUIET)$| \w+::$|_LIBRARY$//; s/.*IMPORTED_TARGET //')
    [ "$(wc -w <<<"$libraries")" -ge "$count" ] || die "too few libraries are found to be needed: $libraries"
    for library in $libraries; do
        found=
        for package in $(packages_of $groups); do
            [[ $(key "$library") == "$(key "$package")"* ]] && found=$package
        done
        [ -n "$found" ] || die "$library is needed to configure, and no package of '$groups' is it"
    done
}
needs 12 "build" CMakeLists.txt {cmake,src/*}/*.cmake apps/cli/CMakeLists.txt
needs 3 "build test" tests/CMakeLists.txt apps/explainer/CMakeLists.txt src/gl/CMakeLists.txt

# Every file that has to state the version states that of VERSION.
version=$(cat VERSION)
for stated in "CITATION.cff:^version: $version$" "examples/vcpkg/ports/crescent/vcpkg.json:\"version\": \"$version\"" \
    "CHANGELOG.md:^## \[$version\]"; do
    grep -q "${stated#*:}" "${stated%%:*}" || die "${stated%%:*} has another version than $version"
done
