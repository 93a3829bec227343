#!/bin/sh
# Removes out/. A folder of the user's own choice, by MBSD_OUT or by a link, is not ours to remove.
set -eu
cd "$(dirname "$0")/.."
if [ -n "${MBSD_OUT:-}" ]; then
    echo "clean: MBSD_OUT is set, so out/ is removed and $MBSD_OUT is left to you" >&2
fi
if [ -L out ]; then
    echo "clean: out is a link, so it and the folder it leads to are left to you: $(ls -ld out | sed 's/.* -> //')" >&2
    exit 0
fi
rm -rf out
