#!/bin/bash
# Follows docs/extending.md exactly, in a copy of the tree: every section adds its fixture, which is built and run, and
# may touch one new file and one existing file, or one existing file alone. The copy stays in the build folder, so that
# only changes are rebuilt.
. "$(dirname "$0")/common.sh"
: "${CRESCENT_BUILD:?the build folder}"
page=$CRESCENT_SOURCE/docs/extending.md
tree=$CRESCENT_BUILD/extending/tree build=$CRESCENT_BUILD/extending/build

mkdir -p fresh
(cd "$CRESCENT_SOURCE" && cp -r --parents CMakeLists.txt VERSION LICENSE cmake include src apps tests "$work/fresh")
cp -r fresh plain

# The file of a `<!-- file PATH -->` is the block of code that follows, that of `<!-- copy FILE FOLDER -->` is FILE, to
# which the page links; the block of `<!-- in PATH -->` is added to PATH, at the end of its namespace. `<!-- list PATH
# "HEADER" WORD -->` is two words there; `<!-- line PATH MACRO ["HEADER"] LINE -->` is a line at the end of the list
# MACRO, and the header that it needs.
add_header() { sed -i "0,/^#include \"/s||#include $2\n&|" "fresh/$1"; } # PATH "HEADER"
add_section() { # TITLE
    awk -v title="## $1" '/^## /{on = $0 == title} on' "$page" >section
    [ -s section ] || die "docs/extending.md has no section '$1'"
    sed -n 's/^<!-- \(file\|in\) \(.*\) -->$/\1 \2/p' section | while read -r how path; do
        awk -v mark="<!-- $how $path -->" '
            $0 == mark { wait = 1; next }
            wait && /^```/ { if (inside) exit; inside = 1; next }
            inside
        ' section >code
        [ -s code ] || die "docs/extending.md has no code for $path"
        [ "$how" = file ] && cp code "fresh/$path" && continue
        awk 'FNR == NR { code = code $0 "\n"; next } /^}  \/\/ namespace/ { print code } 1' code "fresh/$path" >listed &&
            mv listed "fresh/$path"
    done || exit 1
    sed -n 's/^<!-- copy \(.*\) -->$/\1/p' section | while read -r file folder; do
        grep -qF "(../$file)" section || die "docs/extending.md has no link to $file"
        cp "$CRESCENT_SOURCE/$file" "fresh/$folder"
    done || exit 1
    sed -n 's/^<!-- list \(.*\) -->$/\1/p' section | while read -r path header word; do
        add_header "$path" "$header"
        sed -i "/^using /,/;/s|>;|, $word>;|" "fresh/$path"
        grep -q "$word>;" "fresh/$path" || die "no list in $path ends where the page says"
    done || exit 1
    sed -n 's/^<!-- line \(.*\) -->$/\1/p' section | while read -r path macro line; do
        case $line in '"'*) add_header "$path" "${line%% *}" && line=${line#* } ;; esac
        awk -v macro="#define $macro(" -v line="$line" '
            index($0, macro) { inside = 1 }
            inside && !/\\$/ { print $0 " \\"; $0 = "    " line; inside = 0 }
            1
        ' "fresh/$path" >listed && mv listed "fresh/$path"
        grep -qF "    $line" "fresh/$path" || die "no list $macro in $path"
    done || exit 1
}

touched=0
for title in "A sampler" "A lobe" "A shape" "A light" "A metric" "A plate" "A verdict"; do
    add_section "$title"
    diff -rq plain fresh | sort >differences || true
    count=$(wc -l <differences)
    places=$((1 + $(grep -c '^<!-- \(file\|copy\) ' section)))
    [ $((count - touched)) -eq $places ] || die "$title touches $((count - touched)) places, not one list and one new file:
$(cat differences)"
    touched=$count
done

# Changes since the last run go into the copy that is built.
mkdir -p "$tree"
(cd "$tree" && find . -type f) | while read -r file; do [ -f "fresh/$file" ] || rm "$tree/$file"; done
(cd fresh && find . -type f) | while read -r file; do
    cmp -s "fresh/$file" "$tree/$file" || { mkdir -p "$(dirname "$tree/$file")" && cp "fresh/$file" "$tree/$file"; }
done

expect 0 cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-g++}" -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG=-O1 -DCRESCENT_SCALAR=ON -DCRESCENT_GL=OFF -DCRESCENT_EXPLAINER=OFF -DCRESCENT_TESTS=ON
expect 0 cmake --build "$build" --target extending
expect 0 "$build/tests/extending" tent half-power
expect 0 "$build/tests/extending" blinn half-power
expect 0 "$build/tests/extending" --scene '
[shapes.it]
kind = "triangle"
corner = [-0.9, 0.9, 0.2]
edge_u = [0.8, 0.1, 0.3]
edge_v = [0.2, 0.7, 0.1]
rho_d = [0.4, 0.3, 0.2]
occludes = true
[lights.panel]
kind = "square"
center = [0.4, 2.0, 0.9]
side = 0.6
radiance = [6.0, 5.0, 4.0]
'
expect 0 "$build/tests/extending" --measured mae error
