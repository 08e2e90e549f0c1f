# One image for every part of Faience; docker-compose.yml says which part a container runs.
FROM python:3.11-slim AS build
WORKDIR /faience
COPY requirements.lock pyproject.toml README.md LICENSE ./
RUN python -m venv .venv && .venv/bin/pip install --no-cache-dir --requirement requirements.lock
COPY worker worker
COPY index index
COPY service service
RUN .venv/bin/pip install --no-cache-dir --no-deps --no-build-isolation .

FROM python:3.11-slim
RUN useradd --system --create-home --home-dir /data faience
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
CMD ["faience", "serve", "--host", "0.0.0.0"]
