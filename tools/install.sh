#!/bin/sh
# Makes .venv with the packages of requirements.lock and begins to compile the solver's kernels; `install.sh bench` adds
# the peers of the benchmarks. What stands already, judged by the content of the lock, is left alone.
set -eu
cd "$(dirname "$0")/.."
python=.venv/bin/python

finds_python() {
    # A working 3.13 with the global lock: the free-threaded build has no wheels for half of the packages.
    "$1" -c 'import sys, sysconfig
sys.exit(sys.version_info[:2] != (3, 13) or bool(sysconfig.get_config_var("Py_GIL_DISABLED")))' >/dev/null 2>&1
}

choose_python() {
    # uv does not look into pyenv, whose shims answer only when the version is switched on; so look there by hand.
    for candidate in python3.13 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.13*/bin/python3.13; do
        if finds_python "$candidate"; then
            "$candidate" -c 'import sys; print(sys.executable)'
            return
        fi
    done
    echo 3.13
}

name_missing_libraries() {
    # In the first second, by any Python there is, before gigabytes are fetched; asked again below.
    for any in $python python3 /usr/bin/python3; do
        if "$any" -c 'import sys; sys.exit(sys.version_info < (3, 8))' >/dev/null 2>&1; then
            "$any" -m shared.system || true
            return
        fi
    done
}

make_environment() {
    name_missing_libraries
    uv=$(sh tools/find_uv.sh)
    if ! finds_python $python; then
        chosen=$(choose_python)
        echo "install: making .venv with Python $chosen"
        rm -rf .venv
        "$uv" venv --quiet --relocatable --python "$chosen" .venv || {
            echo "error: Python 3.13 was neither found nor fetched; install it (Debian: pyenv install 3.13," \
                "Mac: brew install python@3.13) and run make again" >&2
            exit 1
        }
    fi
    rm -f .venv/requirements.lock .venv/requirements-bench.lock .venv/kernels-compiled
    echo "install: packages of requirements.lock (3 GB when all are new)"
    "$uv" pip sync --quiet --python $python --compile-bytecode --require-hashes requirements.lock || {
        echo "error: the packages of requirements.lock could not be installed; uv says why above." \
            "The same command goes on from here" >&2
        exit 1
    }
    cp requirements.lock .venv/requirements.lock
}

if ! { [ -x $python ] && cmp -s requirements.lock .venv/requirements.lock; }; then
    make_environment
fi

# An environment may be copied or moved with its clone. Those made before it could be name their Python by its place.
if [ -f .venv/pyvenv.cfg ] && ! grep -q '^relocatable = true' .venv/pyvenv.cfg; then
    uv=$(sh tools/find_uv.sh)
    for file in .venv/pyvenv.cfg .venv/bin/*activate*; do
        if [ -f "$file" ]; then # uv writes into these files, which a copy of hard links shares
            cp -p "$file" "$file.own"
            mv "$file.own" "$file"
        fi
    done
    "$uv" venv --quiet --relocatable --allow-existing --python $python .venv
    $python tools/movable.py
fi

# The solver and the rooms beside it, for scripts in any folder: `.venv/bin/python my_script.py`. The path is seen from
# the packages, so a copy of the clone imports its own sources.
for packages in .venv/lib/python3*/site-packages; do
    if [ -d "$packages" ] && [ ! -f "$packages/mbsd.pth" ]; then
        rm -rf "$packages"/__editable__*mbsd* "$packages"/mbsd-*.dist-info
        echo ../../../.. >"$packages/mbsd.pth"
    fi
done

# The program by its name: `.venv/bin/mbsd run excavator` in any folder, also through a link to it. -P: a user's folder
# may hold files with names of ours.
if [ -d .venv/bin ] && [ ! -f .venv/bin/mbsd ]; then
    cat >.venv/bin/mbsd <<'PROGRAM'
#!/bin/sh
place=$(readlink -f "$0" 2>/dev/null || echo "$0")
exec "$(dirname "$place")/python" -P -m mbsd "$@"
PROGRAM
    chmod +x .venv/bin/mbsd
fi

# Who commits with checks gets them from this clone, too.
hook=.git/hooks/pre-commit
if grep -qs '^INSTALL_PYTHON=' $hook && ! grep -qF "$(pwd -P)/.venv/bin/python" $hook; then
    $python -m pre_commit install >/dev/null
fi

if [ ! -f .venv/kernels-compiled ]; then
    $python -m tools.compiling begin
fi

# Asked again until nothing is missing; the solver runs without these libraries, parts and pictures do not.
if [ ! -f .venv/libraries-found ]; then
    if $python -m shared.system; then
        touch .venv/libraries-found
    fi
fi

if [ "${1:-}" = bench ] && ! cmp -s requirements-bench.lock .venv/requirements-bench.lock; then
    uv=$(sh tools/find_uv.sh)
    echo "install: peers of the benchmarks"
    "$uv" pip install --quiet --python $python --require-hashes -r requirements-bench.lock
    cp requirements-bench.lock .venv/requirements-bench.lock
fi
