#!/bin/bash
# As a part of another project crescent builds no program, no tests and no video, installs nothing, and leaves the
# project's settings unchanged. By default it is only crescent::check: no other library than its four is searched for or
# included, no compiler warns, and a test of GoogleTest runs. CRESCENT_RUN=ON adds the rest (not compiled here).
. "$(dirname "$0")/common.sh"

others="OpenEXR Imath Boost tomlplusplus hwy PNG PkgConfig"
disabled=()
for name in $others; do disabled+=("-DCMAKE_DISABLE_FIND_PACKAGE_$name=ON"); done

# Below a folder src, as trees are fetched, and in a project whose own folders have the names of ours.
mkdir -p outer/src && ln -s "$CRESCENT_SOURCE" outer/src/crescent
for folder in "$CRESCENT_SOURCE"/src/*/; do
    mkdir "outer/$(basename "$folder")"
    for header in "$folder"*.h; do
        printf '#error "a header of this project, not of crescent"\n' >"outer/$(basename "$folder")/${header##*/}"
    done
done
cat >outer/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(outer LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 17)
get_cmake_property(before VARIABLES)
foreach(name IN LISTS before)
  set(value_of_${name} "${${name}}")
endforeach()
set(seen "before;name;seen;changed")
add_subdirectory(src/crescent)
foreach(name IN LISTS before)
  if(name MATCHES "^CMAKE_(CXX|BUILD|POSITION|INTERPROCEDURAL|MESSAGE|UNITY)" AND
     NOT "${${name}}" STREQUAL "${value_of_${name}}")
    message(FATAL_ERROR "crescent changed ${name} to ${${name}}")
  endif()
endforeach()
get_property(tests DIRECTORY src/crescent PROPERTY TESTS)
if(tests OR TARGET crescent_check_tests OR TARGET crescent_cli OR TARGET crescent_explainer)
  message(FATAL_ERROR "crescent builds more than its libraries: ${tests}")
endif()
get_property(targets DIRECTORY src/crescent PROPERTY BUILDSYSTEM_TARGETS)
foreach(target IN LISTS targets)
  get_target_property(sources ${target} SOURCES)
  if(sources MATCHES "crescent/tests/")
    message(FATAL_ERROR "${target} has files of the tests in it")
  endif()
endforeach()
find_package(GTest REQUIRED)
add_executable(mine mine.cpp)
target_include_directories(mine BEFORE PRIVATE .)
target_link_libraries(mine PRIVATE GTest::gmock GTest::gtest_main)
if(CRESCENT_RUN)
  target_link_libraries(mine PRIVATE crescent::check crescent::crescent)
else()  # whole: nothing in it needs a source that is left out
  target_link_libraries(mine PRIVATE "$<LINK_LIBRARY:WHOLE_ARCHIVE,crescent::check>")
endif()
END

# Every field of the structs that users fill in, by its name, in the order of declaration.
fields() { # TYPE HEADER
    sed 's, *//.*,,' "$CRESCENT_SOURCE/src/$2" |
        awk -v start="struct $1 {" '$0 == start { inside = 1; next } inside && /^};/ { exit } inside && !/ using /' |
        grep -E '^    [^ ].*;$' | grep -vE '\(|^    (enum|static) ' |
        sed -E 's/\{[^}]*\}|= *[^,;]+//g; s/^.*[ >]([a-z_]+) *, *([a-z_]+) *;$/\1\n\2/; s/^.* ([a-z_]+) *;$/\1/'
}
{
    printf '#include <crescent/check.h>\n#include <crescent/gtest.h>\n'
    count=0
    for type in TestSettings:check/check.h Traits:samplers/traits.h; do
        for field in $(fields "${type%:*}" "${type#*:}"); do
            printf 'crescent::%s field_%d{.%s = {}};\n' "${type%:*}" $((++count)) "$field"
        done
    done
    cat <<'END'
struct Glass {  // a smooth boundary, as it is filled in by users
    struct Drawn { std::array<double, 3> wi; double pdf, weight, delta; };
    Drawn sample(std::array<double, 3> wo, std::array<double, 2>) const {
        return {{-wo[0], -wo[1], wo[2]}, 1, 1, 1};
    }
    double pdf(std::array<double, 3>, std::array<double, 3>) const { return 0; }
    crescent::Traits traits() const { return {.wo = crescent::Traits::WoDomain::both, .eta = 1.5}; }
};
struct Cosine {
    struct Drawn { std::array<float, 3> wi; float pdf; };
    Drawn sample(std::array<float, 3>, std::array<float, 2> u) const {
        const float r = std::sqrt(u[0]), phi = 6.2831853f * u[1], z = std::sqrt(1 - u[0]);
        return {{r * std::cos(phi), r * std::sin(phi), z}, z / 3.1415927f};
    }
    float pdf(std::array<float, 3>, std::array<float, 3> wi) const { return wi[2] > 0 ? wi[2] / 3.1415927f : 0; }
};
TEST(Cosine, IsRight) { EXPECT_THAT(Cosine{}, crescent::IsARightSampler()); }
TEST(Cosine, IsRightAtOneAngle) {
    EXPECT_THAT(Cosine{}, crescent::IsARightSamplerBy(crescent::TestSettings{.wo = {{30, 0}}}));
}
TEST(Glass, HasAnIndexOfOneNumber) { EXPECT_EQ(Glass{}.traits().eta->z, 1.5); }
END
} >outer/mine.cpp
[ "$(grep -c field_ outer/mine.cpp)" -ge 18 ] || die "too few fields are found: $(grep field_ outer/mine.cpp)"

# Our headers as they are, not as a system's, to both compilers.
strict=(-std=c++20 -O2 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
for compiler in g++ clang++-19; do
    command -v $compiler >/dev/null || continue
    expect 0 $compiler "${strict[@]}" -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" -fsyntax-only outer/mine.cpp
done

# crescent::check alone, with warnings as errors.
configure() { expect 0 cmake -S outer -B "outer/$1" -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-g++}" "${@:2}"; }
configure build "${disabled[@]}" -DCMAKE_CXX_COMPILER=g++ -DCMAKE_CXX_FLAGS='-Wall -Wextra -Werror' \
    -DCMAKE_CXX_FLAGS_RELEASE=-O1
grep -q '^CMAKE_BUILD_TYPE:STRING=$' outer/build/CMakeCache.txt ||
    die "crescent chose a build type: $(grep BUILD_TYPE outer/build/CMakeCache.txt)"
installs=outer/build/src/crescent/cmake_install.cmake
[ ! -s $installs ] || ! grep -q 'INSTALL.*FILES "' $installs || die "crescent installs itself with its parent"
library='openexr|imath|boost|toml|hwy|highway|libpng|pango|cairo'
! grep -iE "^($library)[^=]*=" outer/build/CMakeCache.txt || die "other libraries are searched for"
expect 0 cmake --build outer/build --target mine
expect 0 outer/build/mine
! ninja -C outer/build -t deps | grep -iE "/($library)" || die "headers of other libraries are included"

# The rest: missing libraries are named once; without plates the libraries for plates are not needed.
configure whole -DCRESCENT_RUN=ON
expect 1 cmake -S outer -B outer/lacking -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-g++}" -DCRESCENT_RUN=ON "${disabled[@]}"
for name in OpenEXR Boost tomlplusplus hwy PNG pangocairo; do
    grep -A4 'CRESCENT_RUN=ON' said | grep -q "$name" || die "$name is not said to be missing: $(cat said)"
done
echo '#!/bin/bash
case "$*" in *pango* | *cairo*) exit 1 ;; esac
exec pkg-config "$@"' >without && chmod +x without
PKG_CONFIG=$PWD/without configure bare -DCRESCENT_RUN=ON -DCRESCENT_PLATES=OFF -DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON
! ninja -C outer/bare -t targets all | grep -q plates/ || die "plates are built without plates"
