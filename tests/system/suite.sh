#!/bin/bash
# A suite that shares alpha keeps it whether its tests run in one process or each in its own. A failing matcher reports
# the failure in at most 12 lines that name C++ calls.
. "$(dirname "$0")/common.sh"
: "${CRESCENT_SUITE:?the suite}"
unset GTEST_TOTAL_SHARDS GTEST_SHARD_INDEX

# spent FILTER: the probability of a false failure of one process that runs these tests.
spent() { "$CRESCENT_SUITE" --gtest_filter="$1" | sed -n 's/^crescent: .* at most \([^ ]*\) of the suite.*/\1/p'; }
together=$(spent 'Suite.*Sampler*:-*Wrong*') one=$(spent Suite.OneSampler) two=$(spent Suite.TwoSamplers)
python3 -c "
together, one, two = $together, $one, $two
assert abs(one + two - together) < 0.01 * together, (one, two, together)
assert one > 1e-4 and one < two and 3 * two <= 1e-3, (one, two)" || die "the shares: $one, $two; together $together"

expect 1 "$CRESCENT_SUITE" --gtest_filter='*Wrong*'
sed -n '/: Failure$/,/^\[  FAILED  \]/p' printed | sed '$d' >message
[ "$(wc -l <message)" -ge 6 ] && [ "$(wc -l <message)" -le 12 ] || die "not 6 to 12 lines: $(cat message)"
grep -q "normalised is wrong: " message && grep -q "at 8 of 8 w_o" message || die "not what and where: $(cat message)"
grep -q "^Next: crescent::IsARightSamplerBy" message && ! grep -q -- " --" message || die "no call: $(cat message)"
