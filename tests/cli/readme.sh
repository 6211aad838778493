#!/bin/bash
# The README's code is true: its C compiles, its Python too, and the options of its commands exist.
. "$(dirname "$0")/check.bash"
readme=$source/README.md
[ -f "$readme" ] || exit 77

# blocks LANGUAGE: the fenced blocks of a language, one after the other
blocks() { awk -v fence="\`\`\`$1" '$0 == fence { inside = 1; next } /^```/ { inside = 0 } inside' "$readme"; }

# ---- C: includes first, all the rest is one function, so that later blocks may use what earlier ones made
blocks c >blocks.c
[ -s blocks.c ] || fail "no C in the README"
if command -v cc >/dev/null && [ -z "${DEM_SANITIZE:-}" ]; then
    {
        echo '#include <stdio.h>'
        grep '^#include' blocks.c
        echo 'int main(void) {'
        grep -v '^#include' blocks.c
        echo 'return 0; }'
    } >readme.c
    cc -std=c17 -Wall -Wextra -Werror -I"$source/lib/include" readme.c -o readme -L"$tools" -ldemshape -ldem 2>said ||
        fail "the README's C does not compile: $(head -5 said)"
fi

# ---- Python
blocks python >readme.py
if [ -s readme.py ] && command -v python3 >/dev/null; then
    python3 -c 'import ast; ast.parse(open("readme.py").read())' || fail "the README's Python does not compile"
    for name in $(grep -oE 'demclump\.[A-Za-z_]+' readme.py | cut -d. -f2 | sort -u); do
        grep -q "\"$name\"" "$source/lib/python/demclump/__init__.py" || fail "README: there is no demclump.$name"
    done
fi

# ---- its scene
blocks js >column.json
[ -s column.json ] || fail "no scene in the README"
if [ "${DEM_EMBREE:-1}" = 1 ]; then
    cp "$source/shapes/clumps/sand.json" .
    printf '%s\n' 'solid hopper' 'facet normal 0 0 1' 'outer loop' 'vertex 0 0 -1' 'vertex 1 0 -1' 'vertex 0 1 -1' \
        endloop endfacet endsolid >hopper.stl
    "$tools/dem-run" column.json --check >said 2>&1 || fail "the README's scene is refused: $(cat said)"
fi

# ---- the options of its commands, in blocks and in lines; a comment may stand behind
{ grep -E '^    (\./build/)?dem-[a-z]+ ' "$readme"; grep -oE '`dem-[a-z]+ [^`]*`' "$readme" | tr -d '`'; } |
    sed 's/  *#.*//; s/[|&].*//; s/^ *//' >commands
[ "$(wc -l <commands)" -gt 10 ] || fail "no commands in the README"
while read -r tool words; do
    sub=
    for word in $words; do
        case $word in
        verify | stability | convergence | scene | test | shape | dimers | convert) sub=$word ;;
        --[a-z]*)
            "$tools/$tool" $sub --help >help
            grep -Eq -- "$(echo "${word%%=*}" | grep -oE -- '--[a-z-]+')\b" help ||
                fail "README: $tool $sub has no $word" ;;
        esac
    done
done <commands
finish
