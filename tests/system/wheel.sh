#!/bin/bash
# The wheels of dist/ in a bare root of Debian with python3 and nothing else, and with a later CPython: the gallery with
# its plates, samplers in Python files, two folders of renders. Numbers and plates are those of the program built here.
. "$(dirname "$0")/common.sh"
wheels_of_this_build
. /etc/os-release
[ "$ID $VERSION_ID" = "debian 12" ] || skip "this is not Debian 12, whose python3 the first wheel is for"
own_namespace
root="$work/root"
bare_root "$root" python3 python3-venv

# Nothing is downloaded inside. The later CPython is copied there with its prefix.
mkdir "$root/wheels"
cp "${wheels[@]}" "$root/wheels"
. "$CRESCENT_SOURCE/tools/python.sh"
pythons=(/usr/bin/python3)
later=$(later_pythons | tail -n 1)
if [ -n "$later" ]; then
    prefix=$("$later" -c 'import sys; print(sys.base_prefix)')
    mkdir -p "$root$prefix" && cp -r "$prefix/bin" "$prefix/lib" "$root$prefix"
    pythons+=("$prefix/bin/${later##*/}")
fi
for python in /usr/bin/python3 $later; do
    "$python" -m pip -q --disable-pip-version-check download --only-binary :all: -d "$root/wheels" numpy >log 2>&1 ||
        skip "PyPI gives no numpy: $(tail -n 1 log)"
done

cat >"$root/mine.py" <<'PY'
import numpy as np
import crescent

print("a sampler may print")

def sample(wo, u):
    r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi

def f(wo, wi):
    return np.where(wi[:, 2] > 0, 1 / np.pi, 0)

sampler = crescent.Sampler(sample, pdf, f)
twice = crescent.Sampler(sample, lambda wo, wi: 2 * pdf(wo, wi))
PY
cp "$tiny" "$root/tiny.toml"
for seed in 1 2 3 4 5 6; do
    side=$([ $seed -le 3 ] && echo old || echo new)
    "$CRESCENT" run "$tiny" --quiet --only films --set seed=$seed --out run >log 2>&1 || die "$(cat log)"
    mkdir -p "$root/$side" && cp run/films/cosine.exr "$root/$side/$seed.exr"
done

# says CODE WORDS COMMAND: its exit code, and that it says so.
says() {
    expect "$1" inside "$3"
    grep -q -- "$2" printed said || die "$3 does not say '$2': $(cat printed said)"
}
for python in "${pythons[@]}"; do
    rm -rf "$root"/env "$root"/out*
    expect 0 inside "$python -m venv /env && /env/bin/pip install --no-index --find-links /wheels crescent-bench"
    image_path=/env/bin:/usr/bin:/bin
    expect 0 "$CRESCENT" --version
    mv printed version && expect 0 inside "crescent --version" && cmp version printed || die "version: $(cat printed)"
    expect 0 inside "cd /tmp && python -c 'import crescent; print(crescent.__version__)'"
    grep -q "^crescent $(cat printed) " version || die "the package has the version $(cat printed)"

    expect 0 inside "crescent run tiny.toml --quiet --out out"
    rm -rf out && cp "$tiny" . && expect 0 "$CRESCENT" run tiny.toml --quiet --out out  # plates state the command
    cmp out/metrics.csv "$root/out/metrics.csv" || die "$python: other numbers than here"
    for plate in out/plates/*.png; do cmp "$plate" "$root/$plate" || die "$python: another plate than here"; done
    [ -s "$root/out/report.html" ] || die "$python: no report"

    expect 0 inside "crescent check mine.py:sampler --json out/mine.json"
    expect 0 inside "crescent check mine.py --wo 30 --against mine.py:sampler --expect same"
    says 1 'normalised' "crescent check mine.py:twice --wo 30"
    says 2 "no 'twic'.*'twice'" "crescent check mine.py:twic"
    says 2 'no such file' "crescent check nowhere.py"
    expect 0 inside "python -m crescent check phong --wo 30 --set s=128 --allow-inconclusive --expect 'support=wrong: known'"
    expect 0 inside "crescent compare --arm old='old/*.exr' --arm new='new/*.exr' --layer n=16 --out out/compare --quiet"
    [ -s "$root/out/compare/report.html" ] || die "$python: no report of compare"
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$root/model.obj"
    expect 0 inside "crescent import model.obj --out out/model"
    expect 0 inside "crescent run out/model/experiment.toml --quiet --set n=1 --out out/model/run"
    expect 0 inside "crescent list"
    expect 0 inside "crescent schema --json"
    # What cannot be in a wheel is named.
    says 3 'install the packages.*libegl-mesa0' "crescent run tiny.toml --quiet --instrument gl --out out/gl"
    says 3 'install the package ffmpeg' "crescent film gallery --out out/film --quiet"
done
expect 0 inside "crescent run gallery --seeds 1 --quiet --out out/gallery"
[ "$(ls "$root"/out/gallery/plates/*.png | wc -l)" -ge 8 ] || die "plates: $(ls "$root"/out/gallery/plates)"
