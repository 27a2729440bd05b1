"""exports.py FOLDER CRESCENT: the draws of the exported C++, in FOLDER/drawn, are those of the JavaScript to 1e-12 of
their size, and `crescent check` gives the exported Python the verdicts that the page gives the JavaScript."""
import concurrent.futures
import json
import pathlib
import subprocess
import sys

folder, crescent = pathlib.Path(sys.argv[1]), sys.argv[2]
expected = json.loads((folder / "expected.json").read_text())
drawn = {}
for line in (folder / "drawn").read_text().splitlines():
    name, *values = line.split()
    drawn.setdefault(name, []).append([None if v == "-" else float(v) for v in values])


def states(name):
    command = [crescent, "check", f"{name}.py:sampler", "--wo", "60", "--quiet", "--json", f"{name}.json"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode in (0, 1, 4), f"{name}: {done.stdout}{done.stderr}"
    report = json.loads((folder / f"{name}.json").read_text())
    return name, {v["name"]: v["state"] for v in report["verdicts"]}


for name, right in expected.items():
    assert len(drawn[name]) == len(right["rows"]), name
    for ours, theirs in zip(drawn[name], right["rows"]):
        for a, b in zip(ours, theirs):
            assert a is None and b is None or abs(a - b) <= 1e-12 * max(1, abs(b)), f"{name}: {ours} in C++, {theirs} in JavaScript"
wrong = []
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    for name, found in pool.map(states, expected):
        # Under one disk light the exported sampler has no f. A program may be asked for more draws than the page takes, so
        # a tail or a mean that is hard to decide may be decided for one of them alone.
        page = {
            verdict: state
            for verdict, state in expected[name]["states"].items()
            if verdict not in ("tail", "mean") and (found[verdict] != "skipped" or state == "skipped")
        }
        same = {verdict: found[verdict] for verdict in page}
        if same != page or len(page) < 4:
            wrong.append(f"{name}: {same} in Python, {page} in the page")
assert not wrong, "\n".join(wrong)
print(f"  {len(expected)} samplers are the same in C++ and in Python")
