#!/bin/bash
# `cmake --install` into an empty prefix, then examples/find_package and examples/in_memory built against it, outside
# the tree.
. "$(dirname "$0")/common.sh"

build_example find_package
expect 0 find_package/build/noise "$tiny"
grep -q mixture printed || die "the example says nothing of mixture: $(cat printed)"
expect 0 "$work/prefix/bin/crescent" --version

# A run in memory: an interval for each arm, no file, a stop that is an answer.
build_example in_memory
mkdir empty && cd empty || exit 1
expect 0 ../in_memory/build/in_memory
[ "$(grep -c 'RMSE [0-9.e-]*, 5 to 95 % of 12 seeds: [0-9.e-]* to [0-9.e-]*' printed)" -eq 2 ] ||
    die "no two intervals: $(cat printed)"
expect 130 ../in_memory/build/in_memory stop
grep -q '^stopped after 3 of 24 jobs$' printed || die "a stop is not answered: $(cat printed)"
[ "$(ls -A)" = "printed
said" ] || die "a run in memory wrote files: $(ls -A)"
