#!/bin/bash
# The explainer video as its users make it: a short cut at 640 x 360, its streams, equal frames, captions, a stop.
. "$(dirname "$0")/common.sh"

command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null ||
    die "no ffmpeg: it is in the group film of tools/packages.txt"
small="$CRESCENT_SOURCE/tests/system/film.toml"

# A cut of four seconds from the first shot into the second.
expect 0 "$CRESCENT" film "$small" --size 360p --from 0:08 --to 0:12 --out cut --quiet
for name in crescent.mp4 crescent.vtt crescent.srt crescent.txt frames.json; do
    [ -s "cut/$name" ] || die "no $name"
done
[ ! -e .cut.crescent ] || die "a stage is left behind"
entries=stream=codec_name,codec_type,width,height,pix_fmt,color_range,color_space,color_transfer,color_primaries
entries+=,r_frame_rate,nb_frames:stream_disposition=attached_pic:chapter_tags=title
ffprobe -v error -show_entries "$entries" -of flat cut/crescent.mp4 >probe 2>said || die "$(cat said)"
for line in 'streams.stream.0.codec_name="h264"' 'streams.stream.0.width=640' 'streams.stream.0.height=360' \
    'streams.stream.0.pix_fmt="yuv420p"' 'streams.stream.0.color_range="tv"' \
    'streams.stream.0.color_space="bt709"' 'streams.stream.0.color_transfer="bt709"' \
    'streams.stream.0.color_primaries="bt709"' 'streams.stream.0.r_frame_rate="30/1"' \
    'streams.stream.0.nb_frames="120"'; do
    grep -qF "$line" probe || die "not in the film: $line
$(cat probe)"
done
grep -q 'codec_name="mov_text"' probe || die "no captions in the film"
grep -q 'attached_pic=1' probe || die "no poster in the film"
[ "$(grep -c 'chapters.chapter.*title' probe)" -eq 2 ] || die "expected the chapters of two shots: $(cat probe)"
[ "$(head -n 1 cut/crescent.vtt)" = WEBVTT ] || die "crescent.vtt is no WebVTT"

# The colours of the video are those of the still: Y'CbCr is converted with the matrix and the range that it states.
expect 0 "$CRESCENT" film "$small" --size 360p --still 0:08 --out still --quiet
ffmpeg -v info -nostdin -i cut/crescent.mp4 -i still/still-*.png -filter_complex \
    '[0:v:0]trim=end_frame=1,format=gbrp[a];[1:v]format=gbrp[b];[a][b]psnr' -frames:v 1 -f null - 2>said ||
    die "$(cat said)"
psnr=$(grep -oP 'min:\K[0-9.]+' said)
awk -v x="${psnr:-0}" 'BEGIN { exit !(x > 38) }' || die "the video's first frame is $psnr dB from the still"

# The same frames with another number of threads and another instruction set.
expect 0 "$CRESCENT" film "$small" --size 360p --from 0:08 --to 0:12 --out again --quiet --threads 1 --isa scalar
cmp -s cut/frames.json again/frames.json || die "frames depend on threads or the instruction set"
cmp -s cut/crescent.srt again/crescent.srt || die "captions depend on threads or the instruction set"

# Ctrl-C: exit 130, the last good video stays.
cp -a cut before
set -m
"$CRESCENT" film "$small" --size 360p --out cut >printed 2>said &
run=$!
set +m
sleep 2
kill -s INT "$run"
wait "$run"
code=$?
[ "$code" -eq 130 ] || die "SIGINT: exit $code: $(cat said)"
diff -r -x '.crescent-*' before cut >difference || die "SIGINT touched the last film: $(cat difference)"

# Missing or wrong parts are reported before the work.
mkdir nothing
PATH="$work/nothing" expect 3 "$CRESCENT" film "$small" --out none --quiet
grep -q 'install the package ffmpeg' said || die "a missing ffmpeg is not told: $(cat said)"
expect 2 "$CRESCENT" film "$small" --size 480p --out none
expect 2 "$CRESCENT" film "$small" --from 1:70 --out none
expect 2 "$CRESCENT" film "$small" --from 59:00 --out none --quiet
sed 's/^\[arms.phong\]/[arms.blinn]/; s/^arm = "phong"/arm = "blinn"/' "$small" >no-phong.toml
expect 2 "$CRESCENT" film no-phong.toml --out none --quiet
grep -q "no arm here samples by 'phong'" said || die "a missing arm is not named: $(cat said)"

# An ffmpeg that exits with 0 and writes no video, or an empty one, or that does not read its frames: a clear error.
mkdir fake
for what in 'cat >/dev/null|not there' 'cat >/dev/null; : >"${!#}"|is empty' 'exit 0|could not encode' \
    'kill -9 $$|SIGKILL'; do
    printf '#!/bin/bash\n[ "$2" = -encoders ] && exec %s "$@"\n%s\n' "$(command -v ffmpeg)" "${what%|*}" >fake/ffmpeg
    chmod +x fake/ffmpeg
    PATH="$work/fake:$PATH" expect 3 "$CRESCENT" film "$small" --size 360p --from 0:08 --to 0:09 --out none --quiet
    grep -q "ffmpeg.*${what#*|}" said || die "ffmpeg '${what%|*}': $(cat said)"
    [ ! -e none/crescent.mp4 ] || die "an empty film was published"
done
