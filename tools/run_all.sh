#!/bin/sh
# run_all.sh MAKE PRESET [PYTHON]: make run-<name> for every mechanism, a table and a summary at the end; non-zero if
# one failed. Variants are mechanisms of their own, run by their own names.
set -u
cd "$(dirname "$0")/.."
export EVERY=1    # spectra of what a mechanism has not are left out
done=0 failed='' rows=''
for file in mechanisms/*/mechanism.py; do
    [ -f "$file" ] || continue
    folder=${file%/mechanism.py}
    name=${folder#mechanisms/}
    # Ranges like a-z depend on the language of the shell.
    case $name in
    [!abcdefghijklmnopqrstuvwxyz]* | *[!abcdefghijklmnopqrstuvwxyz0123456789_]*)
        printf "run-all: error: mechanisms/%s is not the name of a mechanism; rename the folder\n" "$name" >&2
        failed="$failed (an unfit name)"
        continue
        ;;
    esac
    echo "run-all: $name"
    start=$(date +%s) outcome=done
    if "$1" --no-print-directory "run-$name" PRESET="$2"; then
        done=$((done + 1))
    else
        failed="$failed $name"
        outcome=failed
    fi
    rows="$rows$name $(($(date +%s) - start)) $outcome
"
done
if [ -n "${3:-}" ] && [ -n "$rows" ]; then
    printf %s "$rows" | "$3" -m render overview
fi
if [ -n "$failed" ]; then
    echo "run-all: $done done, failed:$failed; their errors stand above, make run-<name> tries one again" >&2
    exit 1
fi
echo "run-all: $done done"
