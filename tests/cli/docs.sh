#!/bin/bash
# Help, man pages and completions come from one table: every option is in all of them, and the shells understand them.
. "$(dirname "$0")/check.bash"
share=$tools/share
[ -d "$share/man/man1" ] || exit 77
export TERM=dumb

# has FILE TEXT: as a word of its own
has() { grep -Eq -- "(^|[^a-z0-9-])$2([^a-z0-9-]|\$)" "$1" || fail "$1: no $2"; }

check_tool() { # NAME FILE_OF_COMPLETIONS TOOL [SUBCOMMAND]
    local name=$1 file=$2 option choice
    shift 2
    run 0 "$@" --help
    cp out help
    [ "$(awk '{ if (length > n) n = length } END { print n }' help)" -le 80 ] || fail "$*: help wider than 80 columns"
    [ -s "$share/man/man1/$name.1" ] || fail "no man page of $name"
    sed 's/\\-/-/g; s/\\f[BIR]//g' "$share/man/man1/$name.1" >page
    for option in $(grep -oE '^ +(-., )?--[a-z0-9-]+' help | grep -oE -- '--?[a-z0-9A-Z-]+'); do
        has page "$option"
        has "$share/bash-completion/completions/$file" "$option"
        has "$share/zsh/site-functions/_$file" "$option"
        case $option in
        --*) has "$share/fish/vendor_completions.d/$file.fish" "-l ${option#--}" ;;
        *) has "$share/fish/vendor_completions.d/$file.fish" "-s ${option#-}" ;;
        esac
    done
    for choice in $(grep -oE -- '--[a-z-]+ [a-z-]+(\|[a-z-]+)+' help | sed 's/.* //; s/|/ /g'); do
        has page "$choice"
        has "$share/bash-completion/completions/$file" "$choice"
        has "$share/zsh/site-functions/_$file" "$choice"
        has "$share/fish/vendor_completions.d/$file.fish" "$choice"
    done
    for section in NAME SYNOPSIS DESCRIPTION OPTIONS 'EXIT STATUS' 'SEE ALSO'; do
        grep -q "^\.SH $section" page || fail "$name.1: no $section"
    done
    ! grep -q '^Examples:' help || grep -q '^\.SH EXAMPLES' page || fail "$name.1: no EXAMPLES"
    [ "$(grep -c '^\.TP' page)" -gt 10 ] || fail "$name.1: too little"
}

for page in "$share"/man/man1/*.1; do
    name=$(basename "$page" .1)
    tool=$(echo "$name" | cut -d- -f1,2)
    sub=$(echo "$name" | cut -s -d- -f3-)
    check_tool "$name" "$tool" "$tool" $sub
    if command -v groff >/dev/null; then
        groff -man -Tutf8 -ww "$page" >rendered 2>said || fail "$name.1: groff failed"
        [ ! -s said ] || fail "$name.1: groff says $(head -3 said)"
        [ "$(wc -l <rendered)" -gt 20 ] || fail "$name.1: nothing rendered"
    fi
    if command -v mandoc >/dev/null; then
        mandoc -Tlint -W warning "$page" >said || fail "$name.1: mandoc says $(head -3 said)"
    fi
done
for tool in dem-clump dem-grain dem-run dem-study dem-view; do
    [ -s "$share/man/man1/$tool.1" ] || fail "no man page of $tool"
    run 0 $tool --version
    prints "^$tool [0-9]+\.[0-9]+\.[0-9]+\$"
done
SOURCE_DATE_EPOCH=86400 "$tools/dem-run" --help=man | grep -q '^\.TH "DEM.*-RUN" 1 1970-01-02 "dem-clump ' || fail "date"
run 2 dem-run --help=html
says "dem-run: error: --help= takes man, bash, zsh or fish, not 'html'; see dem-run --help"

# ---- bash: offers WANTED WORD...: what is offered behind the words, sorted
offers() {
    local wanted=$1
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    "_${1//-/_}"
    local got
    got=$(printf '%s\n' "${COMPREPLY[@]}" | sort | paste -sd' ')
    [ "$got" = "$wanted" ] || fail "bash: behind '$*': '$got', not '$wanted'"
}
mkdir files && cd files && mkdir deep && touch a.stl b.obj
for tool in dem-clump dem-grain dem-run dem-study dem-view; do
    . "$share/bash-completion/completions/$tool"
    [ "$(complete -p $tool)" = "complete -F _${tool//-/_} $tool" ] || fail "bash: $tool is not completed"
done
offers '--effort' dem-clump --eff
offers 'best default fast' dem-clump --effort ''
offers 'fast' dem-clump a.stl --effort f
offers 'best default fast' dem-clump --effort =
offers 'best' dem-clump --effort = b
offers 'a.stl b.obj deep' dem-run ''
offers 'a.stl' dem-clump -n 5 a
offers 'a.stl b.obj deep' dem-clump a.stl -o ''
offers '' dem-clump --spheres ''
offers '' dem-clump --unit ''
offers '' dem-grain ''
offers 'a.stl b.obj deep' dem-view ''
offers 'deep' dem-run -o ''
offers '' dem-run -D ''
offers 'a.stl b.obj deep' dem-run --resume ''
offers '--help' dem-run --he
# a subcommand is found by its function
offers 'convert' dem-clump conv
offers '--json' dem-clump convert --js
_dem_grain_sieve() { COMPREPLY=(of the sieve); }
offers 'sieve' dem-grain s
offers 'of sieve the' dem-grain sieve ''
cd ..

# ---- the other shells, where they are
if command -v zsh >/dev/null; then
    for file in "$share"/zsh/site-functions/_*; do
        zsh -n "$file" || fail "zsh: $file"
        [ "$(head -1 "$file")" = "#compdef $(basename "$file" | cut -c2-)" ] || fail "zsh: $file: no #compdef"
    done
fi
if command -v fish >/dev/null; then
    export HOME=$work XDG_CONFIG_HOME=$work XDG_DATA_HOME=$work
    fish_offers() {
        local got
        got=$(cd files && fish --no-config -c "source $share/fish/vendor_completions.d/${2%% *}.fish
            complete -C '$2'" | cut -f1 | sort | paste -sd' ')
        [ "$got" = "$1" ] || fail "fish: behind '$2': '$got', not '$1'"
    }
    fish_offers '--effort' 'dem-clump --eff'
    fish_offers 'best default fast' 'dem-clump --effort '
    fish_offers 'a.stl' 'dem-clump a'
    fish_offers 'a.stl b.obj deep/' 'dem-view '
    fish_offers '' 'dem-grain '
fi
finish
