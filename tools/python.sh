# Shell functions of ./wheel and ./test: environments, the Python module in the build tree, the wheel, its tests.
# Sourced after setup.sh. Nothing is downloaded from PyPI that an environment already has.

# find_python [GIVEN]: the interpreter to build for; by default the system's python3.
find_python() {
    local python=${1:-/usr/bin/python3}
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && { echo "$python"; return; }
    say "$python: expected CPython 3.11 or later"
    return 1
}

# later_pythons: each CPython from 3.12 on that has its headers, one per version: from PATH, or from pyenv, whose
# commands in PATH do not start if another version is selected.
later_pythons() {
    local minor at
    for minor in $(seq 12 30); do
        for at in "$(command -v "python3.$minor")" \
            "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor."*"/bin/python3.$minor"; do
            [ -f "$("$at" -c 'import sysconfig; print(sysconfig.get_path("include"))' 2>/dev/null)/Python.h" ] ||
                continue
            echo "$at"
            break
        done
    done
}

# serving ENVIRONMENT WHEEL...: the first of these wheels that can be installed there.
serving() {
    local dir=$1 file
    shift
    for file in "$@"; do
        "$dir/bin/python" -m pip -q --disable-pip-version-check install --dry-run --no-deps --no-index "$file" \
            >/dev/null 2>&1 && { echo "$file"; return; }
    done
}

# make_environment DIR PYTHON PACKAGE...: a virtual environment that has these packages. Exit 3 if PyPI has none.
make_environment() {
    local dir=$1 python=$2 log
    shift 2
    log="$log_dir/$(basename "$dir").log"
    [ -x "$dir/bin/python" ] && [ "$("$dir/bin/python" -V 2>&1)" = "$("$python" -V 2>&1)" ] || {
        rm -rf "$dir"
        "$python" -m venv "$dir" >"$log" 2>&1 || fail 3 "$log" "$python -m venv failed: is python3-venv installed?"
    }
    [ "$(cat "$dir/has" 2>/dev/null)" = "$*" ] && return
    "$dir/bin/python" -m pip -q --disable-pip-version-check install "$@" >"$log" 2>&1 ||
        fail 3 "$log" "not to be had from PyPI: $*"
    printf '%s' "$*" >"$dir/has"
}

# add_python_module DIR: adds the Python module to the release build, with an environment of its own in DIR. If that is
# not possible, prints a message and omits it: nothing else depends on it.
add_python_module() {
    local python packages=(nanobind numpy pytest mypy matplotlib pandas xarray mitsuba jax 'arviz<1')
    packages+=('dask==2026.8.*' 'distributed==2026.8.*' 'dask-jobqueue==0.9.*' 'pyarrow==26.*')  # of sweeps
    packages+=(wgpu)  # of shaders
    python=$(find_python) && (make_environment "$1" "$python" "${packages[@]}") ||
        { say "going on without the Python package: its environment could not be made"; return; }
    # For the slangc in it: PyTorch, which it asks for, is not installed.
    ls "$1"/lib/python3*/site-packages/slangtorch/bin/slangc >/dev/null 2>&1 ||
        "$1/bin/python" -m pip -q --disable-pip-version-check install --no-deps slangtorch \
            >"$log_dir/slangc.log" 2>&1 || say "going on without slangc (log: $log_dir/slangc.log)"
    grep -qxF "CRESCENT_PYTHON:BOOL=ON" "$root/build/CMakeCache.txt" 2>/dev/null &&
        grep -qF "$1/bin/python" "$root/build/CMakeCache.txt" && return
    configure release
    (cd "$root" && cmake --preset release -DCRESCENT_PYTHON=ON -DPython_EXECUTABLE="$1/bin/python") \
        >"$log_dir/python.log" 2>&1 ||
        say "going on without the Python package (log: $log_dir/python.log)"
}

# make_sdist ENVIRONMENT DIST: the sources.
make_sdist() {
    local log="$log_dir/sdist.log"
    "$1/bin/python" -m build --sdist --no-isolation -o "$2" "$root" >"$log" 2>&1 || fail 3 "$log" "making the sdist failed"
}

# make_wheel ENVIRONMENT DIST: builds and repairs; sets `wheel` to the file. Clang's kernels are a quarter faster than
# those of g++ 12.
make_wheel() {
    local tools=$1 dist=$2 raw="$root/build/python-raw" log="$log_dir/wheel.log" start=$SECONDS made
    say "building the wheel (log: ${log#"$root"/})"
    rm -rf "$raw"
    (cd "$root" && CXX=${CXX:-$(command -v clang++-19 || echo c++)} PATH="$tools/bin:$PATH" \
        "$tools/bin/python" -m pip --disable-pip-version-check wheel -v . --no-build-isolation --no-deps -w "$raw") \
        >"$log" 2>&1 || fail 3 "$log" "building the wheel failed"
    made=$(ls "$raw"/*.whl) || fail 3 "$log" "no wheel came of it"
    PATH="$tools/bin:$PATH" "$tools/bin/python" "$root/tools/repair_wheel.py" "$made" "$raw/repaired" >>"$log" 2>&1 ||
        fail 3 "$log" "auditwheel could not repair ${made##*/}"
    made=$(ls "$raw"/repaired/*.whl)
    [ "$(stat -c %s "$made")" -lt 40000000 ] || fail 1 "$log" "${made##*/} has 40 MB or more"
    wheel="$dist/${made##*/}"
    mv "$made" "$wheel" || fail 3 "$log" "cannot write $wheel"
    say "built ${wheel##*/} in $((SECONDS - start)) s"
}

# try_wheel ENVIRONMENT WHEEL: installs it there, runs its tests and a check with it, without any file of the
# repository.
try_wheel() {
    local dir=$1 log="$log_dir/$(basename "$1").log"
    "$dir/bin/python" -m pip -q --disable-pip-version-check install --force-reinstall "$2" >"$log" 2>&1 ||
        fail 3 "$log" "installing ${2##*/} failed"
    (cd / && "$dir/bin/python" -m pytest -q "$root/python/tests" --rootdir="$root/python/tests" -p no:cacheprovider) \
        >>"$log" 2>&1 ||
        fail 1 "$log" "the wheel does not pass its tests"
    (cd / && "$dir/bin/crescent" check cosine) >>"$log" 2>&1 || fail 1 "$log" "crescent check cosine failed"
    say "${2##*/} on $("$dir/bin/python" -V): $(tail -n 20 "$log" | grep -E '^[0-9]+ passed' | tail -n 1)"
}
