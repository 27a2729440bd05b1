#!/bin/bash
# --instrument gl, as users call it: both contexts, the CPU's numbers, the provenance of outputs, and the errors if a
# part of GL is missing, wrong or too old.
. "$(dirname "$0")/common.sh"

code=0
"$CRESCENT" run "$tiny" --quiet --instrument gl --out egl >printed 2>said || code=$?
[ "$code" -eq 0 ] || [ "$code" -eq 3 ] || die "exit $code: $(cat said)"
[ "$code" -eq 0 ] || skip "$(head -n 1 said)"
expect 0 "$CRESCENT" run "$tiny" --quiet --out cpu

# like A B: the numbers of two runs agree to 1e-4; film hashes are not part of metrics.csv.
like() {
    paste -d '\n' "$1/metrics.csv" "$2/metrics.csv" | tr -d '\r' | awk '
        NR % 2 { n = split($0, first, ","); next }
        {
            if (split($0, second, ",") != n) { print "other columns: " $0; exit 1 }
            for (i = 1; i <= n; ++i) {
                a = first[i]; b = second[i]
                if (a == b) continue
                off = a - b; if (off < 0) off = -off
                if (a !~ /^-?[0-9.]+(e-?[0-9]+)?$/ || off > 1e-4 * (a < 0 ? -a : a)) { print a " is not " b; exit 1 }
            }
        }' >difference || die "$1 and $2: $(cat difference)"
}
like cpu egl

# The driver's words are in the provenance; the same run gives the same bytes.
for word in GL_VERSION GL_RENDERER 'EGL surfaceless' '--instrument gl' 'is complete RGBA32F' \
    'has GL_FRAMEBUFFER_SRGB off' 'has no MSAA'; do
    grep -q -- "$word" egl/metrics.json || die "metrics.json says nothing of $word"
done
grep -q GL_ cpu/metrics.json && die "a run on the CPU speaks of GL"
expect 0 "$CRESCENT" run "$tiny" --quiet --instrument gl --out again
same_outputs egl again

expect 0 "$CRESCENT" list devices
grep -q '^0  ' printed || die "no device 0: $(cat printed)"
expect 0 "$CRESCENT" run "$tiny" --quiet --instrument gl --gl-device 0 --out device
grep -q -- '--gl-device 0' device/metrics.json || die "the command does not name the device"

# OSMesa, if it is installed.
if "$CRESCENT" run "$tiny" --quiet --instrument gl --gl-context osmesa --out osmesa >printed 2>said; then
    like cpu osmesa
    grep -q '"context": "OSMesa"' osmesa/metrics.json || die "the provenance does not name OSMesa"
    grep -q -- '--gl-context osmesa' osmesa/metrics.json || die "the command does not name OSMesa"
else
    grep -q libOSMesa said || die "OSMesa fails for another reason than that it is missing: $(cat said)"
fi

# A driver that has only core 3.3.
if grep -q llvmpipe egl/metrics.json; then
    expect 0 env MESA_GL_VERSION_OVERRIDE=3.3 MESA_GLSL_VERSION_OVERRIDE=330 "$CRESCENT" run "$tiny" --quiet \
        --instrument gl --out old
    grep -q '"GL_VERSION": "3.3' old/metrics.json || die "not a 3.3 context: $(grep GL_VERSION old/metrics.json)"
    like cpu old
fi

# Missing parts are named, nothing is written, and the CPU needs none of them.
no_outputs() {
    [ ! -e "$1" ] || [ -z "$(find "$1" -type f)" ] || die "outputs of a run that failed: $(find "$1" -type f)"
}
expect 3 env __EGL_VENDOR_LIBRARY_FILENAMES="$work/absent.json" "$CRESCENT" run "$tiny" --instrument gl --out none
grep -q 'no GL context' said || die "no word of the context: $(cat said)"
no_outputs none
mkdir broken
printf 'not a library' | tee broken/libEGL.so.1 >broken/libOSMesa.so.8
expect 3 env LD_LIBRARY_PATH="$work/broken" "$CRESCENT" run "$tiny" --instrument gl --out none
grep -q 'libEGL.so.1 cannot be opened' said || die "the message does not name libEGL: $(cat said)"
expect 3 env LD_LIBRARY_PATH="$work/broken" "$CRESCENT" run "$tiny" --instrument gl --gl-context osmesa --out none
grep -q 'libOSMesa.so.8 cannot be opened' said || die "the message does not name libOSMesa: $(cat said)"
no_outputs none
expect 0 env LD_LIBRARY_PATH="$work/broken" "$CRESCENT" list devices
expect 0 env LD_LIBRARY_PATH="$work/broken" __EGL_VENDOR_LIBRARY_FILENAMES="$work/absent.json" "$CRESCENT" run "$tiny" \
    --quiet --out without
same_outputs cpu without

# A wrong choice is an input error.
expect 2 "$CRESCENT" run "$tiny" --instrument gl --gl-device 99
grep -q 'crescent list devices' said || die "no hint at the list of devices: $(cat said)"
expect 2 "$CRESCENT" run "$tiny" --instrument gl --gl-device first
expect 2 "$CRESCENT" run "$tiny" --instrument gl --gl-context glx
expect 2 "$CRESCENT" run "$tiny" --instrument gl --gl-context osmesa --gl-device 0
expect 2 "$CRESCENT" run "$tiny" --gl-context egl
grep -q -- '--instrument gl' said || die "no hint at --instrument gl: $(cat said)"
expect 2 "$CRESCENT" run "$tiny" --gl-device 0

# Ctrl-C, in the middle of films.
set -m
"$CRESCENT" run "$tiny" --instrument gl --out egl --set 'arms.cosine.n=[16777216]' >printed 2>said &
run=$!
set +m
sleep 2
start=$(date +%s%N)
kill -s INT "$run"
wait "$run"
code=$?
took=$((($(date +%s%N) - start) / 1000000))
[ "$code" -eq 130 ] || die "SIGINT: exit $code: $(cat said)"
[ "$took" -le 1000 ] || die "SIGINT: took $took ms"
same_outputs egl again
