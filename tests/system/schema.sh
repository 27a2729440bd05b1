#!/bin/bash
# `crescent schema --json` is a JSON Schema: python3-jsonschema accepts it, every experiment of the tree and tiny.toml
# obey it, and mistakes that the program rejects are rejected by it too. docs/experiment.schema.json is its output.
. "$(dirname "$0")/common.sh"
/usr/bin/python3 -c 'import jsonschema, tomllib' 2>said || die "python3-jsonschema or tomllib is missing: $(cat said)"

expect 0 "$CRESCENT" schema --json
cp printed schema.json
cmp -s schema.json "$CRESCENT_SOURCE/docs/experiment.schema.json" ||
    die "docs/experiment.schema.json is old: build/crescent schema --json >docs/experiment.schema.json"

# The tables of an experiment with one mistake; the program must reject it too.
mistake() { sed "$1" "$tiny" >"mistake-$2.toml" && ! cmp -s "$tiny" "mistake-$2.toml" || die "no such line: $1"; }
mistake 's/^width = .*/width = 0/' range
mistake 's/^width = .*/widht = 8/' key
mistake 's/kind = "sphere"/kind = "spheer"/' word
mistake 's/^radius = .*/radius = "wide"/' type
mistake '0,/^radius = .*/{/^radius = .*/d}' missing
mistake 's/kind = "sphere"/kind = "sphere"\nedge_u = [1, 0, 0]/' foreign
for file in mistake-*.toml; do expect 2 "$CRESCENT" run "$file" --out nowhere; done

expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" "$tiny" <<'END'
import glob, json, sys, tomllib
import jsonschema
schema = json.load(open("schema.json"))
jsonschema.Draft7Validator.check_schema(schema)
judge = jsonschema.Draft7Validator(schema)
read = lambda path: tomllib.load(open(path, "rb"))
for path in glob.glob(sys.argv[1] + "/experiments/*.toml") + [sys.argv[2]]:
    assert open(path).readline().startswith("#:schema ") or path == sys.argv[2], f"{path} names no schema"
    for error in judge.iter_errors(read(path)): sys.exit(f"{path}: {error.json_path}: {error.message}")
for path in glob.glob("mistake-*.toml"):
    assert not judge.is_valid(read(path)), f"{path} passes the schema"
END

# metrics.json of a run obeys docs/metrics.schema.json, and a wrong one does not.
expect 0 "$CRESCENT" run "$tiny" --quiet --out measured
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import json, sys
import jsonschema
schema = json.load(open(sys.argv[1] + "/docs/metrics.schema.json"))
judge = jsonschema.validators.validator_for(schema)(schema)
judge.check_schema(schema)
metrics = json.load(open("measured/metrics.json"))
for error in judge.iter_errors(metrics): sys.exit(f"metrics.json: {error.json_path}: {error.message}")
for wrong in ({**metrics, "unknown": 1}, {**metrics, "runs": 3}, {k: v for k, v in metrics.items() if k != "runs"}):
    assert not judge.is_valid(wrong), "a wrong metrics.json passes the schema"
END

# The samples of the tests of metrics.json: names, infinities, nothing measured, heavy tails; and three that must not
# fit.
mkdir samples
expect 0 env -u GTEST_TOTAL_SHARDS CRESCENT_METRICS_SAMPLES=samples "${CRESCENT_REPORT_TESTS:?the tests of src/report}" --gtest_brief=1 \
    --gtest_filter='MetricsJson.*'
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import glob, json, sys
import jsonschema
schema = json.load(open(sys.argv[1] + "/docs/metrics.schema.json"))
judge = jsonschema.validators.validator_for(schema)(schema)
fits, breaks = glob.glob("samples/fits-*.json"), glob.glob("samples/breaks-*.json")
assert len(fits) >= 5 and len(breaks) >= 3, f"{len(fits)} and {len(breaks)} samples"
for path in fits:
    for error in judge.iter_errors(json.load(open(path))): sys.exit(f"{path}: {error.json_path}: {error.message}")
for path in breaks: assert not judge.is_valid(json.load(open(path))), f"{path} fits the schema"
END
