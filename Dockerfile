# docker build -t rovval . && docker run --rm rovval          the demo
# docker run --rm -v "$PWD:/data" rovval rovval run /data/pipelines/nightly.toml
ARG PYTHON=docker.io/library/python:3.12-slim
FROM ${PYTHON} AS build
WORKDIR /src
COPY pyproject.toml README.md LICENSE ./
COPY src ./src
RUN python3 -m venv /opt/rovval && /opt/rovval/bin/pip install --no-cache-dir ".[all]"

FROM ${PYTHON}
COPY --from=build /opt/rovval /opt/rovval
RUN groupadd --gid 10001 rovval \
    && useradd --uid 10001 --gid rovval --create-home rovval \
    && install --directory --owner=rovval --group=rovval /data
ENV PATH=/opt/rovval/bin:$PATH
# By number, so that Kubernetes can see that it is not root (runAsNonRoot).
USER 10001:10001
WORKDIR /data
CMD ["rovval", "demo"]
