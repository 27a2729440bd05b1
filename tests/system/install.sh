#!/bin/bash
# `cmake --install` into an empty prefix, then examples/find_package, examples/in_memory and the README's snippets built
# against it outside the tree, the snippets without the libraries that the check alone does not need.
. "$(dirname "$0")/common.sh"

build_example find_package
expect 0 find_package/build/noise "$tiny"
grep -q mixture printed || die "the example says nothing of mixture: $(cat printed)"
expect 0 "$work/prefix/bin/crescent" --version
stray=$(find "$work/prefix" -name '_crescent*')
[ -z "$stray" ] || die "the Python module belongs into the wheel: $stray"

# CMake of the README and of docs/install.md, and the README's C++, as printed there.
snippet() { # LANGUAGE PAGE
    awk -v mark="\`\`\`$1" '$0 == mark { inside = 1; next } inside && /^```/ { exit } inside' "$CRESCENT_SOURCE/$2"
}
readme() { # FOLDER PAGE
    mkdir "$1"
    {
        echo 'cmake_minimum_required(VERSION 3.25)'
        echo 'project(readme LANGUAGES CXX)'
        echo 'find_package(GTest REQUIRED)'
        echo 'add_executable(my_tests my_tests.cpp)'
        snippet cmake "$2"
        if [ "$2" = README.md ]; then
            echo 'add_executable(plugin ../plugin.cpp)'
            echo 'target_link_libraries(plugin PRIVATE crescent::check)'
        fi
    } >"$1/CMakeLists.txt"
    snippet cpp README.md >"$1/my_tests.cpp"
    expect 0 cmake -S "$1" -B "$1/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1 \
        -DCMAKE_CXX_COMPILER="${CXX:-g++}" "${@:3}"
}
none=()
for name in OpenEXR Imath Boost tomlplusplus hwy PNG PkgConfig; do none+=("-DCMAKE_DISABLE_FIND_PACKAGE_$name=ON"); done
# A user's program that loads a plugin: it is executed again as the plugin's host, before its own main().
cat >plugin.cpp <<'END'
#include <cstdio>

#include <crescent/check/sources/plugin.h>

int main(int, char** words) {
    std::puts("main");
    const auto plugin = crescent::open_plugin(words[1]);
    std::vector<crescent::Draw> out(1);
    plugin->sample(0, {0, 0, 1}, std::vector<crescent::PrimarySample>{{0.25, 0.5}}, out);
    std::printf("%s %.6f\n", plugin->name().c_str(), out[0].pdf);
}
END
readme readme README.md -DCMAKE_PREFIX_PATH="$work/prefix" "${none[@]}"
expect 0 cmake --build readme/build
expect 0 readme/build/my_tests
grep -q '1 test' printed || die "the README's sampler is not judged: $(cat printed)"
readme fetched docs/install.md -DFETCHCONTENT_SOURCE_DIR_CRESCENT="$CRESCENT_SOURCE"  # subproject.sh compiles it
# Without components: only crescent::check if the rest lacks a library; requested by name, the rest is an error.
for components in '' 'COMPONENTS check' 'COMPONENTS run'; do
    rm -rf lacking && mkdir lacking
    {
        echo 'cmake_minimum_required(VERSION 3.25)'
        echo 'project(lacking LANGUAGES CXX)'
        echo "find_package(crescent REQUIRED $components)"
        echo 'if(NOT TARGET crescent::check)'
        echo '  message(FATAL_ERROR "no crescent::check")'
        echo 'endif()'
    } >lacking/CMakeLists.txt
    code=0
    [ "$components" != 'COMPONENTS run' ] || code=1
    expect $code cmake -S lacking -B lacking/build -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" "${none[@]}"
done
grep -q OpenEXR said || die "what is missing is not said: $(cat said)"

expect 0 "${CC:-cc}" -O2 -shared -fPIC -I"$work/prefix/include" -o libcosine.so \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" -lm
expect 0 readme/build/plugin ./libcosine.so
[ "$(cat printed)" = "main
cosine in C 0.159155" ] || die "a plugin in another program: $(cat printed)"

# A run in memory: an interval for each arm, no file, and a stop returned as a value.
build_example in_memory
mkdir empty && cd empty || exit 1
expect 0 ../in_memory/build/in_memory
[ "$(grep -c 'RMSE [0-9.e-]*, 5 to 95 % of 12 seeds: [0-9.e-]* to [0-9.e-]*' printed)" -eq 2 ] ||
    die "no two intervals: $(cat printed)"
expect 130 ../in_memory/build/in_memory stop
grep -q '^stopped after 3 of 24 jobs$' printed || die "a stop is not answered: $(cat printed)"
[ "$(ls -A)" = "printed
said" ] || die "a run in memory wrote files: $(ls -A)"
