#!/bin/bash
# What a person reads in one sitting, on one screen: files of at most 600 lines, lines of at most 120 columns, functions
# of at most 60 lines.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
cd "$CRESCENT_SOURCE" || exit 1
measure="$CRESCENT_SOURCE/laws/scripts/lengths.py"
most=60

# It finds each of the three, and takes neither a table nor a raw string for code.
{
    printf '// %0118d\nint long_one(int x) {\n' 0
    for ((k = 1; k < most; ++k)); do echo '    x += 1;'; done
    printf '    return x;\n}\n\nvoid table() {\n    const Row rows[] = {\n'
    for _ in {1..90}; do echo '        {1, "one"},'; done
    printf '    };\n    text = R"(\n'
    for _ in {1..90}; do echo 'prose'; done
    printf ')";\n}\n'
} >"$work/planted.cpp"
yes '//' | head -n 601 >"$work/file.cpp"
python3 "$measure" "$most" "$work/planted.cpp" "$work/file.cpp" >"$work/found" &&
    die "nothing of what was planted is found"
sed "s|$work/||" "$work/found" | diff - <(
    echo 'planted.cpp:1: 121 columns, at most 120'
    echo "planted.cpp:2: a function of $((most + 2)) lines, at most $most: int long_one(int x) {"
    echo 'file.cpp: 601 lines, at most 600'
) || die "found is not what was planted"

for folder in src cli gl explainer python web film laws tests bench examples tools cmake CMakeLists.txt run test \
    wheel; do
    [ -d "$folder" ] || [ -f "$folder" ] && find "$folder" -type f \( -name '*.cpp' -o -name '*.h' -o -name '*.c' \
        -o -name '*.glsl' -o -name '*.in' -o -name '*.sh' -o -name '*.py' -o -name '*.cmake' -o -name CMakeLists.txt \
        -o -name run -o -name test -o -name film -o -name wheel \)
done >"$work/files"
[ "$(wc -l <"$work/files")" -gt 500 ] || die "too few files: $(wc -l <"$work/files")"
xargs python3 "$measure" "$most" <"$work/files" >"$work/found"
[ ! -s "$work/found" ] || die "$(cat "$work/found")"
