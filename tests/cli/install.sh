# An installed library is found by pkg-config and by CMake, and a program of ten lines runs with it.
set -eu
build=$1 source=$2
[ -n "${DEM_SANITIZE:-}" ] && exit 77   # the program would need the sanitizer's runtime too
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/root" >/dev/null
export PKG_CONFIG_PATH="$work/root/lib/pkgconfig:$work/root/lib/$(gcc -print-multiarch 2>/dev/null)/pkgconfig"
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
cc -std=c17 "$work/use.c" -o "$work/use" $(pkg-config --cflags --libs --static demshape) -lm
"$work/use"
mkdir "$work/cmake"
cat >"$work/cmake/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.18)
project(use C)
find_package(dem REQUIRED)
add_executable(use ../use.c)
target_link_libraries(use dem::demshape m)
END
cmake -S "$work/cmake" -B "$work/cmake/build" -DCMAKE_PREFIX_PATH="$work/root" >"$work/log" 2>&1 &&
    cmake --build "$work/cmake/build" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/cmake/build/use"
# every public header compiles alone, in C17 and in C++
for header in "$work"/root/include/dem/*.h; do
    echo "#include <dem/$(basename "$header")>" >"$work/alone.c"
    cc -std=c17 -Wall -Wextra -Werror -I"$work/root/include" -c "$work/alone.c" -o "$work/alone.o"
    c++ -x c++ -std=c++17 -Wall -Wextra -Werror -I"$work/root/include" -c "$work/alone.c" -o "$work/alone.o"
done
