# crescent on Debian 12: the program, built as ./run builds it.
#   docker build -t crescent . && docker run --rm -v "$PWD/out:/out" crescent run experiments/gallery.toml --out /out
# Left out: what --instrument gl opens (libegl-mesa0, libgl1-mesa-dri) and what `crescent film` starts (ffmpeg).
FROM debian:12 AS build
COPY . /crescent
WORKDIR /crescent
RUN apt-get update && ./run --help && cmake --install build --prefix /opt/crescent --strip

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
    fonts-inter libcairo2 libpango-1.0-0 libpangocairo-1.0-0 libpng16-16 libopenexr-3-1-30 libimath-3-1-29 libtbb12 \
    libfmt9 libxxhash0 libhwy1 libtomlplusplus3 libstdc++6 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/crescent /usr/local
COPY --from=build /crescent/experiments /crescent/experiments
WORKDIR /crescent
ENTRYPOINT ["crescent"]
CMD ["--help"]
