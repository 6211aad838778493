# What is installed is enough: programs are built against it by pkg-config and CMake, shared and static, and find their
# libraries; Python finds the module; man pages, completions and schemas are where they belong.
set -eu
build=$1 source=$2
[ -n "${DEM_SANITIZE:-}" ] && exit 77   # the program would need the sanitizer's runtime too
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root="$work/root" include="$work/root/include" share="$work/root/share"
cmake --install "$build" --prefix "$root" >/dev/null
libdir=$(dirname "$(find "$root" -name libdem.so)")
export PKG_CONFIG_PATH="$libdir/pkgconfig"
warnings="-std=c17 -Wall -Wextra -Werror"
cat >"$work/use.c" <<'END'
#include <dem/dem.h>
#include <math.h>
#include <stdio.h>
int main(void)
{
    dem_ball balls[2] = {{{0, 0, 0}, 1}, {{1, 0, 0}, 1}};
    dem_union u;
    dem_error error;
    if (dem_balls_union(balls, 2, &u, &error) != DEM_OK)
        return 1;
    printf("%s %.12f\n", dem_version(), u.solid.volume);
    return fabs(u.solid.volume - 9 * 3.14159265358979 / 4) > 1e-9;
}
END

# the examples, against the shared libraries: a program needs no more than those
for example in pack run; do
    cc $warnings "$source/tests/examples/$example.c" -o "$work/$example" $(pkg-config --cflags --libs demshape) \
        -Wl,-rpath,"$libdir"
done
ldd "$work/pack" | grep -q "$libdir/libdemshape.so.0.1" || { echo "pack is not linked to the installed library"; exit 1; }
if ldd "$work/run" | grep -Eiq 'cgal|assimp|gmp'; then
    echo "a program that runs scenes needs more than libdem"
    exit 1
fi
"$work/pack" "$source/shapes/grains/angular.obj" "$work/grain.json" >"$work/spheres"
grep -Eq '^[0-9]+ spheres, [0-9.e-]+ kg, IoU gap [0-9.]+ %$' "$work/spheres"
[ "$(wc -l <"$work/spheres")" -gt 20 ]
if "$work/pack" nowhere.obj "$work/x.json" 2>"$work/said"; then echo "no file, no error"; exit 1; fi
grep -q '^nowhere.obj:0: no such file' "$work/said"
"$work/run" "$source/tests/examples/scene.json" >"$work/rest"
[ "$(grep -c '^body . rests at' "$work/rest")" = 3 ]

# the static ones: everything in the program but what the distribution has
cc $warnings "$work/use.c" -o "$work/use" $(pkg-config --cflags demshape) -Wl,-Bstatic -ldemshape -ldem -Wl,-Bdynamic \
    -L"$libdir" $(pkg-config --static --libs demshape | sed 's/-ldem\(shape\)\?\>//g') -lm
"$work/use"
if ldd "$work/use" | grep -q libdem; then echo "static, but not so"; exit 1; fi

# CMake
mkdir "$work/cmake"
cat >"$work/cmake/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.18)
project(use C)
find_package(dem REQUIRED COMPONENTS shared)
if(PNG_FOUND)
  message(FATAL_ERROR "the shared libraries alone need nothing else")
endif()
add_executable(use_shared ../use.c)
target_link_libraries(use_shared dem::demshape_shared m)
find_package(dem REQUIRED)
add_executable(use ../use.c)
target_link_libraries(use dem::demshape m)
END
cmake -S "$work/cmake" -B "$work/cmake/build" -DCMAKE_PREFIX_PATH="$root" >"$work/log" 2>&1 &&
    cmake --build "$work/cmake/build" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/cmake/build/use"
"$work/cmake/build/use_shared"

# every public header compiles alone, in C17 and in C++
for header in "$include"/dem/*.h; do
    echo "#include <dem/$(basename "$header")>" >"$work/alone.c"
    cc $warnings -pedantic -I"$include" -c "$work/alone.c" -o "$work/alone.o"
    c++ -x c++ -std=c++17 -Wall -Wextra -Werror -pedantic -I"$include" -c "$work/alone.c" -o "$work/alone.o"
done
# and serves a program in C++
cat >"$work/use.cpp" <<'END'
#include <dem/dem.h>
#include <cmath>
int main()
{
    dem_ball balls[2] = {{{0, 0, 0}, 1}, {{1, 0, 0}, 1}};
    dem_union u;
    dem_make_options options = dem_make_defaults();
    return dem_balls_union(balls, 2, &u, nullptr) != DEM_OK || options.pack.spheres == 0 ||
           std::fabs(u.solid.volume - 9 * 3.14159265358979 / 4) > 1e-9;
}
END
c++ -std=c++17 -Wall -Wextra -Werror "$work/use.cpp" -o "$work/use_cpp" $(pkg-config --cflags --libs demshape) \
    -Wl,-rpath,"$libdir"
"$work/use_cpp"

# Python finds the installed libraries without being told, also where the tree was moved
mv "$root" "$work/moved"
for python in python3 /usr/bin/python3; do
    "$python" -c 'import numpy' 2>/dev/null || continue
    module=$(dirname "$(find "$work/moved" -name demclump -type d)")
    (cd "$work" && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$module" "$python" -c "
import demclump
clump = demclump.load('grain.json')
assert clump.fidelity.iou_gap < 0.1 and demclump.union(clump.spheres).pieces == 1
assert demclump._library._dem._name.startswith('$work/moved'), demclump._library._dem._name")
    break
done

# the rest is in its place
share="$work/moved/share"
for tool in dem-clump dem-grain dem-run dem-study dem-view; do
    for file in "$work/moved/bin/$tool" "$share/man/man1/$tool.1" "$share/bash-completion/completions/$tool" \
        "$share/zsh/site-functions/_$tool" "$share/fish/vendor_completions.d/$tool.fish"; do
        [ -s "$file" ] || { echo "not installed: $file"; exit 1; }
    done
done
[ -s "$share/dem-clump/dem-clump-1.schema.json" ] && [ -s "$share/dem-clump/dem-scene-1.schema.json" ]
"$work/moved/bin/dem-clump" --version
