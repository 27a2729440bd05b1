#!/bin/bash
# `cmake --install` into an empty prefix, then examples/find_package built against it, outside the tree.
. "$(dirname "$0")/common.sh"
: "${CRESCENT_BUILD:?the build folder}"

expect 0 cmake --install "$CRESCENT_BUILD" --prefix "$work/prefix"
cp -r "$CRESCENT_SOURCE/examples/find_package" example
expect 0 cmake -S example -B example/build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="${CXX:-g++}" -DCMAKE_PREFIX_PATH="$work/prefix"
expect 0 cmake --build example/build
expect 0 example/build/noise "$tiny"
grep -q mixture printed || die "the example says nothing of mixture: $(cat printed)"
expect 0 "$work/prefix/bin/crescent" --version
