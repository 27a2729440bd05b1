#!/bin/bash
# As a part of another project crescent builds no program, no tests and no film, installs nothing, and leaves what the
# project chose as it was. Nothing is compiled here.
. "$(dirname "$0")/common.sh"

mkdir outer && ln -s "$CRESCENT_SOURCE" outer/crescent
cat >outer/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(outer LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 17)
get_cmake_property(before VARIABLES)
foreach(name IN LISTS before)
  set(value_of_${name} "${${name}}")
endforeach()
set(seen "before;name;seen;changed")
add_subdirectory(crescent)
foreach(name IN LISTS before)
  if(name MATCHES "^CMAKE_(CXX|BUILD|POSITION|INTERPROCEDURAL|MESSAGE)" AND
     NOT "${${name}}" STREQUAL "${value_of_${name}}")
    message(FATAL_ERROR "crescent changed ${name} to ${${name}}")
  endif()
endforeach()
get_property(tests DIRECTORY crescent PROPERTY TESTS)
if(tests OR TARGET crescent_tests OR TARGET crescent_cli OR TARGET crescent_film)
  message(FATAL_ERROR "crescent builds more than its libraries: ${tests}")
endif()
get_property(targets DIRECTORY crescent PROPERTY BUILDSYSTEM_TARGETS)
foreach(target IN LISTS targets)
  get_target_property(sources ${target} SOURCES)
  if(sources MATCHES "crescent/laws/")
    message(FATAL_ERROR "${target} has samplers of the laws in it")
  endif()
endforeach()
add_executable(mine mine.cpp)
target_link_libraries(mine PRIVATE crescent::verdicts crescent::crescent)
END
echo 'int main() {}' >outer/mine.cpp
expect 0 cmake -S outer -B outer/build -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-g++}" -DCMAKE_CXX_FLAGS_RELEASE=-O1
grep -q '^CMAKE_BUILD_TYPE:STRING=$' outer/build/CMakeCache.txt ||
    die "crescent chose a build type: $(grep BUILD_TYPE outer/build/CMakeCache.txt)"
installs=outer/build/crescent/cmake_install.cmake
[ ! -s $installs ] || ! grep -q 'INSTALL.*FILES "' $installs || die "crescent installs itself with its parent"

# Without plates, as pip builds the Python module, nothing is asked for that only they need.
echo '#!/bin/bash
case "$*" in *pango* | *cairo*) exit 1 ;; esac
exec pkg-config "$@"' >without && chmod +x without
PKG_CONFIG=$PWD/without expect 0 cmake -S outer -B outer/bare -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-g++}" \
    -DCRESCENT_PLATES=OFF -DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON
! ninja -C outer/bare -t targets all | grep -q plates/ || die "plates are built without plates"
