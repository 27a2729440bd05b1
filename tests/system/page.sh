#!/bin/bash
# The page as its readers open it: the same bits in node and in Chromium as from the program, the lessons by keyboard,
# no request, no line on the console, samplers written in it, every width. $CRESCENT_PAGE is the build of ./page.
. "$(dirname "$0")/common.sh"
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
[ -f "${CRESCENT_PAGE:-}/crescent.wasm" ] || skip "the page is not built (./test builds it)"
for tool in node esbuild; do command -v "$tool" >/dev/null || skip "no $tool"; done

esbuild "$CRESCENT_SOURCE/tests/system/browser/hashes.ts" \
    --bundle --format=iife --target=es2022 --log-level=warning >hashes.js || die "hashes.ts"
expect 0 node "$CRESCENT_SOURCE/apps/web/pack.mjs" "$CRESCENT_PAGE" "$work/crescent.html"

# axe-core, of the version and content that package-lock.json names; without npm or a network this test is skipped.
cp "$CRESCENT_SOURCE"/tests/system/browser/package*.json . && command -v npm >/dev/null &&
    npm ci --ignore-scripts --no-audit --no-fund --prefer-offline >npm.log 2>&1 &
fetched=$!
# The hashes that the page shows as the program's.
node "$CRESCENT_SOURCE/apps/web/native.mjs" "$CRESCENT" >native.json 2>native.log &
programs=$!

# Every sampler over three scenes, small.
arms=$(usable_arms)
for name in tiny three-glosses two-lamps; do
    from="$CRESCENT_SOURCE/experiments/$name.toml"
    [ "$name" = tiny ] && from=$tiny
    { awk '/^\[/ { off = /^\[+(arms|exponent|furnaces|plates|assertions)/ } !off' "$from"
        for arm in $arms; do printf '\n[arms.%s]\nn = [4, 16]\n' "$arm"; done; } >"$name-all.toml"
done
expect 0 "$FILM_HASHES" tiny-all.toml three-glosses-all.toml two-lamps-all.toml
awk '/ note-reference | under a sky, | paired | flip |^function /{ next } / quadrature /{ print; next } { $2 = ""; $0 = $0; $1 = $1; print }' printed |
    sort -u >native
[ "$(wc -l <native)" -gt 70 ] || die "too few films: $(cat native)"
expect 0 node --no-warnings "$CRESCENT_SOURCE/tests/system/browser/hashes.mjs" hashes.js "$CRESCENT_PAGE/crescent.wasm" \
    tiny-all.toml three-glosses-all.toml two-lamps-all.toml
sort -u printed >node
diff native node >difference || die "films differ in node: $(head -n 12 difference)"

wait "$programs" && diff native.json "$CRESCENT_SOURCE/apps/web/native.json" >difference ||
    die "apps/web/native.json is not the program's (node apps/web/native.mjs build/crescent): $(cat native.log difference)"

# The verdicts of the page, and the samplers of its exercises before and after their repair.
api() { esbuild "$CRESCENT_SOURCE/$1" --format=esm --target=es2022 --log-level=warning --outfile="$2" "${@:3}" || die "$1"; }
api apps/web/api.ts api.mjs
api tests/system/browser/exercises.ts exercises.mjs --bundle
"$CRESCENT" check phong --wo 60 --quiet --json phong.json >/dev/null
in_node() {
    expect 0 node --no-warnings "$CRESCENT_SOURCE/tests/system/browser/$1.mjs" "$work/$2.mjs" \
        "$CRESCENT_PAGE/crescent.wasm" "${@:3}"
    cat printed
}
in_node verdicts api phong.json 60
in_node tiles api "$CRESCENT_SOURCE/experiments/gallery.toml"
body='regions.body={shape = "ball"}'  # its pixels, not its box, plan the samples
expect 0 "$CRESCENT" run "$tiny" --quiet --only metrics --seeds 1 --set "$body" --out tails
in_node tails api "$tiny" "$work/tails/metrics.json" "$body"
in_node exercises exercises

# The programs that the page exports have its verdicts.
api tests/system/browser/exports.ts exports.mjs --bundle
mkdir exported && in_node exports exports "$work/exported"
expect 0 python3 "$CRESCENT_SOURCE/tests/system/browser/exports.py" exported "$CRESCENT"
cat printed

python=/usr/bin/python3  # Debian's, which has Debian's selenium
command -v chromium >/dev/null && command -v chromedriver >/dev/null &&
    $python -c 'import selenium' 2>/dev/null || skip "no Chromium that can be driven"
# The hash that the page itself shows under a picture of an experiment of the tree.
expect 0 "$FILM_HASHES" "$CRESCENT_SOURCE/experiments/three-glosses.toml"
SHOWN=$(awk '$3 == "phong" && $4 == "n=16" { print $5; exit }' printed)
export SHOWN

wait "$fetched"
in_chromium() {
    $python "$CRESCENT_SOURCE/tests/system/browser/page.py" "$1" crescent.html hashes.js native \
        tiny-all.toml three-glosses-all.toml two-lamps-all.toml
}
in_chromium readers >readers.log 2>&1 &  # each group waits for its own browser most of the time
readers=$!
expect 0 in_chromium numbers
cat printed
expect 0 in_chromium writers
cat printed
wait "$readers" || die "$(cat readers.log)"
cat readers.log

# A second browser engine, if there is one, alone: its workers are slow to start on a busy machine.
if ! { command -v WebKitWebDriver && command -v xvfb-run; } >/dev/null; then echo 'no WebKit to try'; exit 0; fi
expect 0 xvfb-run -a $python "$CRESCENT_SOURCE/tests/system/browser/webkit.py" crescent.html "$SHOWN"
cat printed
