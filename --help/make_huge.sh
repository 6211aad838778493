#!/bin/sh
# usage: make_huge.sh OUT.stl [SUBDIV=9]   (SUBDIV 9 = 5.2M triangles, 262 MB; 8 = 1.3M, 66 MB)
exec python3 "$(dirname "$0")/make_huge.py" "$@"
