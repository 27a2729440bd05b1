# What a reader of suites.md has: renders of one view in out/.
mkdir out
for k in 1 2 3 4 5 6 7 8; do
    crescent run tests/system/tiny.toml --quiet --set seed=$k --set arms.cosine.n=32 --set image.width=80 \
        --set image.height=60 --seeds 1 --only films --out renders
    mv renders/films/cosine.exr out/crown-$k.exr
done
