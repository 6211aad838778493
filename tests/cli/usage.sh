#!/bin/bash
# What every tool does with its command line, shown with dem-grain.
. "$(dirname "$0")/check.bash"
[ -x "$tools/dem-grain" ] || exit 77

run 0 dem-grain --help
prints '^Usage: dem-grain '
prints '--quiet'
[ "$(awk '{ if (length > n) n = length } END { print n }' out)" -le 80 ] || fail "help wider than 80 columns"
cp out long
run 0 dem-grain -h
cmp -s out long || fail "-h is not --help"
run 0 dem-grain --version
prints '^dem-grain [0-9]+\.[0-9]+\.[0-9]+$'

usage() { run 2 dem-grain "${@:2}" -o x.obj; says "dem-grain: error: $1"; [ ! -e x.obj ] || fail "$ran: wrote"; }
usage 'unknown option --sede; did you mean --seed?' --sede 3
usage 'unknown option --outpt; did you mean --output?' --outpt=y
usage 'unknown option --zzz; see dem-grain --help' --zzz
usage 'unknown option -x; see dem-grain --help' -qx
usage '--json takes no value; see dem-grain --help' --json=yes
usage "--seed must be a whole number from 0 to 9007199254740992, not '1.5'; see dem-grain --help" --seed 1.5
usage "--seed must be a whole number from 0 to 9007199254740992, not '-1'; see dem-grain --help" --seed -1
usage "--threads must be a whole number from 1 to 4096, not '0'; see dem-grain --help" -j0
usage "--elongation must be a number from 0.02 to 1, not 'nan'; see dem-grain --help" --elongation nan
usage "--elongation must be a number from 0.02 to 1, not '0,5'; see dem-grain --help" --elongation 0,5
usage "--size must be a length from 1e-09 to 1000000000 m, not '-2mm'; see dem-grain --help" --size -2mm
usage "--size: '1e400' is not a length; write a number with a unit, as in \"2 mm\"; see dem-grain --help" --size 1e400
usage "--size needs a value: --size D; see dem-grain --help" --size --json
usage "unexpected 'a.obj'; name the file to write with -o; see dem-grain --help" a.obj
run 2 dem-grain --size 2parsec -o x.obj
mentions "'parsec' is not a unit of length; use one of: m cm mm"
one_line
run 2 dem-grain -o
says 'dem-grain: error: --output needs a value: --output FILE; see dem-grain --help'

# the same thing said in other ways
run 0 dem-grain -q --seed 5 --size 2mm -o a.obj
silent
run 0 dem-grain --quiet --seed=5 '--size=0.2 cm' -j1 --output=b.obj
run 0 dem-grain -qj 2 --seed 4 --seed 5 --size .002 -ob2.obj
cmp -s a.obj b.obj && cmp -s a.obj b2.obj || fail "options spelled differently gave other grains"
run 2 dem-grain -o c.obj -- -q
mentions "unexpected '-q'"

# colours and locale
run 2 dem-grain --zzz
grep -q "$(printf '\033')" err && fail "colours in a file"
env LC_ALL=de_DE.UTF-8 "$tools/dem-grain" -q --seed 5 --size 2mm -o d.obj
cmp -s a.obj d.obj || fail "the locale changes files"

# standard output that cannot be written
if [ -c /dev/full ]; then
    "$tools/dem-grain" --help >/dev/full 2>err && fail "--help into a full disk succeeded"
    ran='dem-grain --help >/dev/full' mentions 'cannot write: No space left'
    one_line
fi
finish
