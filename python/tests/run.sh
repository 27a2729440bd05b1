#!/bin/bash
# run.sh BUILD: runs the package's tests on the module in BUILD/python, with the interpreter that it was built for. 77
# if there is no module.
build=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
ls "$build"/python/crescent/_crescent.*.so >/dev/null 2>&1 ||
    { echo "no Python module in $build: configured without nanobind"; exit 77; }
python=$(sed -n 's/^_\?Python_EXECUTABLE:[A-Z]*=//p' "$build/CMakeCache.txt" | head -n 1)
"$python" -c 'import numpy, pytest' 2>/dev/null || { echo "$python has no numpy and pytest"; exit 77; }
PYTHONPATH="$build/python" exec "$python" -m pytest -q -p crescent.pytest_plugin -p no:cacheprovider "$here"
