# One image for every part of Faience; docker-compose.yml says which part a container runs.
ARG PYTHON=python:3.11.14-slim-bookworm
FROM ${PYTHON} AS build
WORKDIR /faience
# Only what the service needs, in the versions that the tests ran with. Python's own compiled files go by content, not by
# the time of the build, so that the same sources give the same files.
ENV PIP_NO_CACHE_DIR=1 PIP_NO_COMPILE=1 PIP_DISABLE_PIP_VERSION_CHECK=1
COPY requirements.lock pyproject.toml README.md LICENSE ./
RUN python -m venv .venv && .venv/bin/pip install --constraint requirements.lock setuptools
COPY worker worker
COPY index index
COPY service service
RUN .venv/bin/pip install --no-build-isolation --constraint requirements.lock . && \
    .venv/bin/python -m compileall -q --invalidation-mode unchecked-hash .venv/lib

FROM ${PYTHON}
RUN useradd --system --create-home --home-dir /data faience && \
    install --directory --owner faience /data/compiled
COPY --from=build /faience/.venv /faience/.venv
ENV PATH=/faience/.venv/bin:$PATH \
    FAIENCE_DATA_DIR=/data/library \
    NUMBA_CACHE_DIR=/data/compiled \
    OMP_NUM_THREADS=1 \
    OPENBLAS_NUM_THREADS=1
USER faience
VOLUME /data
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=3s --start-period=20s \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8000/readyz', timeout=2)"]
STOPSIGNAL SIGTERM
CMD ["faience", "serve", "--host", "0.0.0.0"]
