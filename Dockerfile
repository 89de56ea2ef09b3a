# clogsweep in a container: Debian 12 with the Debian package and nothing else, run by an ordinary user.
#
#   docker build -t clogsweep .
#   docker run --rm -v "$PWD:/data" --user "$(id -u):$(id -g)" clogsweep mpirun -np 2 clogsweep --config sweep.cfg --output sweep.h5
#
# docs/how-to/install.md says more. podman and buildah take it, too.

FROM docker.io/library/debian:12-slim AS build
# By themselves, so that they are not installed anew when a source has changed.
COPY jobs/install-dependencies.sh /clogsweep/jobs/
COPY cmake/dependencies.txt /clogsweep/cmake/
RUN /clogsweep/jobs/install-dependencies.sh docs package
COPY . /clogsweep
WORKDIR /clogsweep
RUN cmake --preset package \
    && cmake --build --preset package \
    && cd build/package && cpack

FROM docker.io/library/debian:12-slim
COPY --from=build /clogsweep/build/package/clogsweep_*.deb /tmp/clogsweep.deb
RUN apt-get update \
    && apt-get install -y --no-install-recommends /tmp/clogsweep.deb \
    && rm -rf /tmp/clogsweep.deb /var/lib/apt/lists/* \
    && useradd --create-home droplet
USER droplet
WORKDIR /data
# Open MPI needs some settings to run in a container.
ENTRYPOINT ["/bin/bash", "-c", ". /usr/share/clogsweep/jobs/mpi-settings.sh && exec \"$@\"", "clogsweep"]
CMD ["clogsweep", "--help"]
