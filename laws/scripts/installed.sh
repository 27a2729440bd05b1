#!/bin/bash
# `cmake --install` into an empty prefix, then examples/find_package built against it, outside the tree.
. "$(dirname "$0")/common.sh"

build_example find_package
expect 0 find_package/build/noise "$tiny"
grep -q mixture printed || die "the example says nothing of mixture: $(cat printed)"
expect 0 "$work/prefix/bin/crescent" --version
