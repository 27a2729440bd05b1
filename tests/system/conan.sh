#!/bin/bash
# examples/conan: `conan create` makes the package and builds and runs its test, with the libraries of this machine in
# place of ConanCenter's.
. "$(dirname "$0")/common.sh"
: "${CRESCENT_BUILD:?the build folder}"
tools="$CRESCENT_BUILD/tools/conan"
[ -x "$tools/bin/conan" ] || { python3 -m venv "$tools" && "$tools/bin/pip" -q install 'conan>=2.7,<3'; } >log 2>&1 ||
    skip "Conan cannot be installed: $(tail -n 1 log)"
export CONAN_HOME="$work/conan" CCACHE_BASEDIR="$work"
mkdir conan
version=$(g++ -dumpversion)
cat >profile <<END_OF_PROFILE
[settings]
os=Linux
arch=$(uname -m | sed 's/aarch64/armv8/')
compiler=gcc
compiler.version=${version%%.*}
compiler.cppstd=20
compiler.libcxx=libstdc++11
build_type=Release
[platform_requires]
fmt/9.1.0
nlohmann_json/3.11.2
onetbb/2021.8.0
xxhash/0.8.1
[conf]
tools.cmake.cmaketoolchain:generator=Ninja
tools.cmake.cmaketoolchain:user_presets=
tools.cmake.cmake_layout:test_folder=\$TMP
END_OF_PROFILE
PATH="$tools/bin:$PATH" expect 0 "$tools/bin/conan" create "$CRESCENT_SOURCE/examples/conan" -pr:a profile --no-remote
grep -q '^right$' printed said || die "the test of the package checks no sampler: $(tail -n 20 said)"
grep -q "crescent/$(cat "$CRESCENT_SOURCE/VERSION")" said || die "another version: $(grep crescent/ said | head -n 1)"
