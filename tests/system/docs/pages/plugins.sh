# Prepares for plugins.md: crescent in ~/crescent, a sampler as a program, and one as a library next to an experiment.
cmake --install build --prefix ~/crescent >/dev/null
cc -O2 -shared -fPIC -I ~/crescent/include/crescent examples/plugin/cosine.c -o libmine.so -lm
cp examples/pipe_samplers/cosine.py theirs.py
