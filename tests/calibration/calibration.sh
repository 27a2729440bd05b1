#!/bin/bash
# A sample of 60 checks: right samplers are not reported wrong, large faults are found, an interrupted run continues,
# and samplers work behind pipes. Error rates are measured separately and are in docs/error-rates.md.
set -u
calibration=$1 compare_rates=$2
[ -x "$calibration" ] && [ -x "$compare_rates" ] || { echo "the programs are not built"; exit 77; }
command -v python3 >/dev/null || { echo "no python3 here"; exit 77; }
work=$(mktemp -d) || exit 3
trap 'rm -rf "$work"' EXIT
die() { echo "calibration: $*" >&2; exit 1; }
run() { "$calibration" "$@" --seed 7 >>"$work/log" 2>&1 || die "'$*' exits with $?: $(tail -n 3 "$work/log")"; }

run right --cases 0:26 --out "$work/right.jsonl"
run power --cases 0:20 --wo 1 --out "$work/power.jsonl"
run kinds --cases 6:12 --wo 1 --out "$work/kinds.jsonl"
run hard --cases 15:19 --wo 1 --out "$work/hard.jsonl"
run right --cases 1:5 --out "$work/pipe.jsonl" --pipe

# Interrupted in the middle of a line and continued: the lines are the same except for their times.
head -c -40 "$work/kinds.jsonl" >"$work/torn.jsonl"
run kinds --cases 6:12 --wo 1 --out "$work/torn.jsonl"

python3 - "$work" <<'PYTHON' || die "see above"
import json, sys
read = lambda name: [json.loads(line) for line in open(f"{sys.argv[1]}/{name}.jsonl")]
bad = []
def expect(holds, what):
    if not holds: bad.append(what)
right, power, kinds, hard, pipe, torn = map(read, ("right", "power", "kinds", "hard", "pipe", "torn"))
expect(len(right) + len(power) + len(kinds) + len(hard) + len(pipe) == 60, "60 checks are run")
for r in right + hard + pipe:
    expect(r["state"] in ("right", "inconclusive"), f"{r['family']}, right, is reported {r['state']}: {r['message']}")
expect(sum(r["state"] == "right" for r in right) >= 20, "most right samplers are reported right")
for r in power:
    expect(r["size"] < 0.1 or r["state"] == "wrong", f"missed: {r['kind']} {r['size']} in {r['family']}")
expect(sum(r["state"] == "wrong" for r in power) >= 14, "14 of 20 faults by size are found")
for r in kinds:
    expect(r["state"] == "wrong", f"missed: {r['kind']} {r['size']} in {r['family']}")
untimed = lambda rows: [{k: v for k, v in r.items() if k != "cpu"} for r in rows]
expect(untimed(torn) == untimed(kinds), "a run that was stopped continues with the same results")
for r in right + power + hard:
    expect(r["evaluations"] > 0 and r["cpu"] > 0, "evaluations and CPU time are counted")
print("\n".join(bad))
sys.exit(bool(bad))
PYTHON

"$calibration" table "$work"/*.jsonl >"$work/table.md" || die "no table is printed"
grep -q '| right | ' "$work/table.md" || die "the table has no right samplers"
[ "$("$calibration" csv "$work/power.jsonl" | wc -l)" -eq 21 ] || die "the CSV has no line for each case"
"$calibration" powr --cases 0:1 >"$work/printed" 2>&1
[ $? -eq 2 ] && grep -q "power" "$work/printed" ||
    die "an unknown set is rejected without a suggestion: $(cat "$work/printed")"

"$compare_rates" --calls 3 >"$work/rates.md" 2>&1 && grep -q "^### Power" "$work/rates.md" ||
    die "no rates of compare: $(cat "$work/rates.md")"
