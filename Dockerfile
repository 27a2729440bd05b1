# crescent on Debian 12: the wheel that ./wheel makes, in an environment of its own.
#   docker build -t crescent . && docker run --rm -v "$PWD/out:/out" crescent run gallery --out /out
# Left out: what --instrument gl opens (libegl-mesa0, libgl1-mesa-dri) and what `crescent film` starts (ffmpeg).
FROM debian:12 AS build
COPY . /crescent
WORKDIR /crescent
RUN apt-get update && ./wheel /usr/bin/python3
RUN python3 -m venv /opt/crescent && /opt/crescent/bin/pip install --no-cache-dir dist/*.whl

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends python3 && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/crescent /opt/crescent
ENV PATH=/opt/crescent/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
WORKDIR /crescent
ENTRYPOINT ["crescent"]
CMD ["--help"]
