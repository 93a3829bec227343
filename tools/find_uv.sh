#!/bin/sh
# Prints the path of a uv that runs; installs one if there is none.
# A version manager's shim may be on PATH without working, so each candidate is tried.
set -u

for uv in uv "$HOME/.local/bin/uv" "$HOME/.cargo/bin/uv" .venv-uv/bin/uv; do
    if "$uv" --version >/dev/null 2>&1; then
        command -v "$uv"
        exit 0
    fi
done

echo "install: uv is missing, installing it into .venv-uv" >&2
for python in python3 python3.13 /usr/bin/python3; do
    if "$python" -m venv .venv-uv >/dev/null 2>&1 && .venv-uv/bin/python -m pip install --quiet uv >&2; then
        echo .venv-uv/bin/uv
        exit 0
    fi
    rm -rf .venv-uv
    if "$python" -m pip install --quiet --user uv >/dev/null 2>&1 && "$HOME/.local/bin/uv" --version >/dev/null 2>&1; then
        echo "$HOME/.local/bin/uv"
        exit 0
    fi
done
echo "error: uv could not be installed (no python3 with venv or pip, or no network);" \
    "install uv by hand (Debian: apt-get install python3-venv, Mac: brew install uv) and run make again" >&2
exit 1
