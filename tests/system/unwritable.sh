#!/bin/bash
# A folder that cannot be written, a full disk, a missing font: exit 3 and a sentence that names it.
. "$(dirname "$0")/common.sh"

touch file
expect 3 "$CRESCENT" run "$tiny" --out file
expect 3 "$CRESCENT" run "$tiny" --out file/below
grep -q file said || die "the message does not name the folder: $(cat said)"
expect 3 "$CRESCENT" run "$tiny" --out /proc/crescent

"$CRESCENT" run "$tiny" --quiet --out stdout >/dev/full 2>said
[ $? -eq 3 ] || die "stdout on a full disk is not noticed"

printf '<?xml version="1.0"?><fontconfig></fontconfig>\n' >no-fonts.conf
expect 3 env FONTCONFIG_FILE="$work/no-fonts.conf" "$CRESCENT" run "$tiny" --out fontless
grep -q 'seed 1 of' said && die "the font is missed only after the work: $(cat said)"
grep -q Inter said || die "the message does not name the font: $(cat said)"
[ -z "$(find fontless -type f 2>/dev/null)" ] || die "outputs without a font: $(find fontless -type f)"

# More memory than available: reported before any of it is used.
expect 3 "$CRESCENT" run "$tiny" --out large --set image.width=16384 --set image.height=16384 \
    --set 'arms.cosine.n=[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]'
grep -q 'GB of memory' said || die "the message does not say how much memory is needed: $(cat said)"
[ ! -e large ] || die "a run that does not fit made a folder"

# Two runs into one folder: the second is rejected.
"$CRESCENT" run "$tiny" --quiet --out shared --set 'arms.cosine.n=[16777216]' >/dev/null 2>&1 &
first=$!
until [ -e .shared.crescent/lock ]; do sleep 0.05; done
expect 3 "$CRESCENT" run "$tiny" --out shared
grep -q 'another run' said || die "the second run is not told of the first: $(cat said)"
kill "$first"
wait "$first" 2>/dev/null

# One target that cannot be replaced: exit 3, and all files are those of the previous run.
expect 0 "$CRESCENT" run "$tiny" --quiet --out held
cp -a held held-before
if mount --bind held/junit.xml held/junit.xml 2>/dev/null; then
    expect 3 "$CRESCENT" run "$tiny" --out held --set seed=11
    umount held/junit.xml
    grep -q 'junit.xml' said || die "the message does not name the file: $(cat said)"
    diff -r held-before held >difference || die "some outputs are new: $(cat difference)"
fi

# A link in the place of an output is not followed, and is reported before the work.
mkdir planted planted/films
ln -s /tmp planted/plates
echo mine >victim.json
expect 3 "$CRESCENT" run "$tiny" --out planted
grep -q 'seed 1 of' said && die "a link on the way is found only after the work: $(cat said)"
grep -q 'planted/plates/' said || die "the message does not name what is in the way: $(cat said)"
rm planted/plates && ln -s "$work/victim.json" planted/metrics.json
expect 3 "$CRESCENT" run "$tiny" --out planted
grep -q 'seed 1 of' said && die "a planted link is found only after the work: $(cat said)"
grep -q 'metrics.json: a link' said || die "the message does not name the link: $(cat said)"
[ "$(cat victim.json)" = mine ] || die "a planted link was followed"

# A disk of 64 KiB, where this process may mount one.
mkdir disk
if mount -t tmpfs -o size=64k none disk 2>/dev/null; then
    trap 'umount "$work/disk"; rm -rf "$work"' EXIT
    expect 3 "$CRESCENT" run "$tiny" --out disk/out
    grep -qi 'space' said || die "the message does not say that the disk is full: $(cat said)"
    [ -z "$(find disk/out -type f 2>/dev/null)" ] || die "a full disk has outputs: $(find disk/out -type f)"
fi
