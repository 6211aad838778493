# For the scripts beside it: run a tool and judge what it did. Source with the arguments of the script.
tools=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset NO_COLOR
failures=0

fail() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# run WANTED_STATUS TOOL ARGUMENTS...: output in the files out and err
run() {
    local wanted=$1 tool=$2 got
    shift 2
    ran="$tool $*"
    timeout 300 "$tools/$tool" "$@" >out 2>err </dev/null
    got=$?
    [ "$got" = "$wanted" ] || fail "$ran: status $got, not $wanted: $(head -c 600 err)"
}

# the last run said exactly this on standard error
says() { [ "$(cat err)" = "$1" ] || fail "$ran: said '$(cat err)', not '$1'"; }
# ... a line holding this extended regular expression
mentions() { grep -Eq -- "$1" err || fail "$ran: no '$1' in '$(cat err)'"; }
prints() { grep -Eq -- "$1" out || fail "$ran: no '$1' in '$(head -c 600 out)'"; }
silent() { [ ! -s out ] && [ ! -s err ] || fail "$ran: not silent: $(cat out err)"; }
one_line() { [ "$(wc -l <err)" = 1 ] || fail "$ran: not one line but '$(cat err)'"; }

finish() { exit $((failures > 0)); }
