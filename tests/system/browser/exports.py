"""exports.py FOLDER CRESCENT: `crescent check` gives the exported programs the verdicts that the page gives their code."""
import concurrent.futures
import json
import pathlib
import subprocess
import sys

folder, crescent = pathlib.Path(sys.argv[1]), sys.argv[2]
expected = json.loads((folder / "expected.json").read_text())


def states(name):
    command = [crescent, "check", "--exec", f"node {name}.mjs", "--wo", "60", "--quiet", "--json", f"{name}.json"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode in (0, 1, 4), f"{name}: {done.stdout}{done.stderr}"
    report = json.loads((folder / f"{name}.json").read_text())
    return name, {v["name"]: v["state"] for v in report["verdicts"]}


wrong = []
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    for name, found in pool.map(states, expected):
        # Under one disk light the program has no f. A program may be asked for more draws than the page takes, so a tail or
        # a mean that is hard to decide may be decided for one of them alone.
        page = {
            verdict: state
            for verdict, state in expected[name].items()
            if verdict not in ("tail", "mean") and (found[verdict] != "skipped" or state == "skipped")
        }
        same = {verdict: found[verdict] for verdict in page}
        if same != page or len(page) < 4:
            wrong.append(f"{name}: {same} in the program, {page} in the page")
assert not wrong, "\n".join(wrong)
print(f"  {len(expected)} exported programs have the verdicts of the page")
