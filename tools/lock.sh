#!/bin/sh
# Writes requirements.lock and requirements-bench.lock from pyproject.toml: exact versions with hashes, no addresses.
# `lock.sh --upgrade` takes the newest versions; otherwise what is locked stays as long as it satisfies pyproject.toml.
set -eu
cd "$(dirname "$0")/.."
uv=$(sh tools/find_uv.sh)
constraints=$(mktemp)
trap 'rm -f "$constraints"' EXIT

compile() {
    "$uv" pip compile pyproject.toml --quiet --universal --python-version 3.13 --generate-hashes \
        --no-annotate --no-header "$@" >/dev/null
}

compile --extra pandas --extra studio --extra docs --extra dev -o requirements.lock "$@"
# The peers are added to the environment, so they must live with the versions above.
sed -n 's/^\([A-Za-z0-9._-]*==[^ ;]*\).*/\1/p' requirements.lock >"$constraints"
compile --extra bench --constraint "$constraints" -o requirements-bench.lock "$@"
echo "lock: $(grep -c == requirements.lock) packages, $(grep -c == requirements-bench.lock) for the benchmarks"
