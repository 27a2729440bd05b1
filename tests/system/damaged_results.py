"""damaged_results.py CRESCENT FILE.json...: stored results in which one value was changed. `report` reads them, or ends
with exit code 2 and names the file and the field, without the codes of the JSON library."""
import copy
import json
import random
import subprocess
import sys

crescent, *files = sys.argv[1:]
tries = 5  # places in each file


def places(value, path=()):
    """Paths of members and of the first entries of lists."""
    inner = value.items() if isinstance(value, dict) else list(enumerate(value))[:2] if isinstance(value, list) else ()
    for key, one in inner:
        yield (*path, key)
        yield from places(one, (*path, key))


def changed(document, path, value):
    out = copy.deepcopy(document)
    parent = out
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    return out


chance = random.Random(1)
for name in files:
    with open(name, encoding="utf-8") as file:
        document = json.load(file)
    refused = 0
    for path in chance.sample(sorted(places(document), key=str), tries):
        for value in ("x", [1], {}, -1.5, None):
            with open("damaged.json", "w", encoding="utf-8") as file:
                json.dump(changed(document, path, value), file)
            done = subprocess.run([crescent, "report", "damaged.json", "--out", "damaged.html"], capture_output=True, text=True, timeout=60)
            said = done.stderr
            assert done.returncode in (0, 2), (name, path, value, said)
            if done.returncode == 0:
                continue
            refused += 1
            assert said.startswith("damaged.json") and "json.exception" not in said, (name, path, value, said)
            near = [str(key) for key in path[-2:]]
            assert any(key in said for key in near) or "hash" in said or "format" in said, (name, path, value, said)
    assert refused > 0, f"{name}: no change was refused"
