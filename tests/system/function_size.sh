#!/bin/bash
# No function of any source that the build compiles has more than 60 lines (.clang-tidy). ./test --matrix alone runs it,
# because it parses every source again.
. "$(dirname "$0")/common.sh"
: "${CRESCENT_BUILD:?the build folder}"
command -v clang-tidy-19 >/dev/null || skip "no clang-tidy-19 here"
mapfile -t sources < <(python3 - "$CRESCENT_BUILD/compile_commands.json" "$CRESCENT_SOURCE" <<'PY'
import json, os, re, sys
ours = re.compile(re.escape(os.path.realpath(sys.argv[2])) + r"/(src|apps|python/src|tests)/.*\.cpp")
files = {os.path.realpath(os.path.join(e["directory"], e["file"])) for e in json.load(open(sys.argv[1]))}
print("\n".join(sorted(f for f in files if ours.fullmatch(f))))
PY
)
[ "${#sources[@]}" -gt 200 ] || die "too few sources in compile_commands.json: ${#sources[@]}"
printf '%s\0' "${sources[@]}" | xargs -0 -n 8 -P "$(nproc)" \
    clang-tidy-19 --quiet -p "$CRESCENT_BUILD" --checks='-*,readability-function-size' >found 2>&1
grep -E "$CRESCENT_SOURCE/[^:]*:[0-9]+:[0-9]+: error" found | sort -u >long
[ ! -s long ] || die "$(head -n 20 long)"
grep 'error:' found | grep -v 'readability-function-size' >other && die "$(head -n 5 other)"
exit 0
