#!/bin/bash
# Direct light against Mitsuba 3: an image sky, and small versions of the five scenes of examples/scenes.
. "$(dirname "$0")/common.sh"
build=${CRESCENT_BUILD:?the build folder}
built=$(sed -n 's/^_\?Python_EXECUTABLE:[A-Z]*=//p' "$build/CMakeCache.txt" | head -n 1)
python=$(command -v "${built:-python3}")
"$python" -c 'import mitsuba, numpy' 2>/dev/null || skip "no Mitsuba 3 here: pip install mitsuba numpy"
/usr/bin/python3 "$here/sky_image.py" sky.exr 64 \
    '(20, 15, 9) if 0.5 * right + 0.6 * up + 0.62 * front > 0.93 else (0.3 + 0.2 * up, 0.4 + 0.2 * up, 0.6 + 0.3 * up)' ||
    die "cannot make the sky"
"$python" "$here/sky_peer.py" "$CRESCENT" sky.exr >printed 2>said || die "$(cat printed said)"

# The full size, at 0.5 %: docs/scenes.md.
PYTHONPATH=$build/python "$python" "$CRESCENT_SOURCE/bench/mitsuba_scenes.py" scenes --side 100 --size 96x60 --seeds 6 \
    --samples 32 --smallest 4% --crescent "$CRESCENT" >printed 2>said || die "$(cat printed said)"
exit 0
