#!/bin/sh
# Removes out/. A folder of the user's own choice is not ours to remove.
set -eu
cd "$(dirname "$0")/.."
if [ -n "${MBSD_OUT:-}" ]; then
    echo "clean: MBSD_OUT is set, so out/ is removed and $MBSD_OUT is left to you" >&2
fi
rm -rf out
