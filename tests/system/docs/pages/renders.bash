# old/ and new/, eight renders each of one scene by different seeds, and truth.exr, one of many samples: made once for
# all pages, next to their folders.
made=$(dirname "$PWD")/renders
if [ -d "$made" ]; then
    cp -r "$made"/* .
    return
fi
render() { # SEED N FILE
    crescent run tests/system/tiny.toml --quiet --set seed=$1 --set arms.cosine.n=$2 --set image.width=560 \
        --set image.height=440 --set reference.kind=paired --set reference.n=1 --seeds 1 --only films --out renders
    mv renders/films/cosine.exr "$3"
}
mkdir old new
for k in 1 2 3 4 5 6 7 8; do
    render $k 32 old/seed0$k.exr
    render 1$k 32 new/seed0$k.exr
done
render 99 1024 truth.exr
mkdir "$made.part" && cp -r old new truth.exr "$made.part" && mv "$made.part" "$made"
