#!/bin/bash
# Models of every format as other programs write them, and damaged ones: each is read whole, or refused with its place.
# Whole scenes become folders with an experiment that runs.
. "$(dirname "$0")/common.sh"
[ -x "$(dirname "$CRESCENT")/crescent-import" ] || command -v crescent-import >/dev/null || skip "this build has no importer"
expect 0 python3 "$here/odd_models.py" "$CRESCENT" "$tiny"
expect 0 python3 "$here/whole_scene.py" "$CRESCENT"
