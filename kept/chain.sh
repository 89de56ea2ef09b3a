#!/bin/bash
# chain.sh PART...: runs the parts of sweeps in order, one rank; each part is NAME@CONFIG@KEY=VALUE,KEY=VALUE
cd /work/runs/full
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
for part in "$@"; do
  IFS=@ read -r name config keys <<<"$part"
  arguments=(--config jobs/figures/$config.full.cfg)
  [ -f jobs/figures/$config.full.csv ] && arguments+=(--points jobs/figures/$config.full.csv)
  for k in ${keys//;/ }; do arguments+=("$k"); done
  echo "$(date +%T) begin $name ${arguments[*]}"
  nice -n 5 ../bin/clogsweep "${arguments[@]}" --output $name.h5 > $name.log 2>&1
  echo "$(date +%T) end $name: $?"
done
