#!/bin/bash
# The Python module over the libraries that were just built; tests/python. Skips where there is no NumPy.
build=$1 source=$2
[ -n "${DEM_SANITIZE:-}" ] && exit 77   # python would need the sanitizer's runtime
for python in python3 /usr/bin/python3; do
    "$python" -c 'import numpy' 2>/dev/null && break
    python=
done
[ -n "$python" ] || { echo "no python3 with numpy"; exit 77; }
[ -e "$build/libdem.so" ] && command -v cc >/dev/null || exit 77
export PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$source/lib/python" DEM_LIBRARY_DIR="$build"
exec "$python" "$source/tests/python/test_demclump.py"
