#!/bin/bash
# A folder that cannot be written, a full disk, a missing font: exit 3 and a sentence that says which.
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
grep -q Inter said || die "the message does not name the font: $(cat said)"
[ -z "$(find fontless -type f 2>/dev/null)" ] || die "outputs without a font: $(find fontless -type f)"

# A disk of 64 KiB, where this process may mount one.
mkdir disk
if mount -t tmpfs -o size=64k none disk 2>/dev/null; then
    trap 'umount "$work/disk"; rm -rf "$work"' EXIT
    expect 3 "$CRESCENT" run "$tiny" --out disk/out
    grep -qi 'space' said || die "the message does not say that the disk is full: $(cat said)"
    [ -z "$(find disk/out -type f 2>/dev/null)" ] || die "a full disk has outputs: $(find disk/out -type f)"
fi
