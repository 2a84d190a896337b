#!/bin/sh
# install.sh: the C side as a static and as a shared library, built and installed by CMake, is found by find_package()
# and by pkg-config, and a C program links it and runs. Most parts are left out, so that it is built sooner.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CMAKE_GENERATOR=Ninja
flags="-O0"
for part in SIMD SPOTS BOXES U16 DEPTH_TEST DEPTH_SLICES SHADERS; do
    flags="$flags -DLIGHTBIN_NO_$part"
done
mkdir "$work/user"
cat >"$work/user/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.18...4.1)
project(user LANGUAGES C CXX)  # C++ for its library, which a static lightbin needs
find_package(lightbin 0.1 REQUIRED)
add_executable(user left_out.c)
target_link_libraries(user PRIVATE lightbin::c)
END
cp "$here/left_out.c" "$work/user"

for shared in OFF ON; do
    prefix=$work/prefix_$shared
    {
        cmake -S "$source" -B "$work/build_$shared" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$flags" -DLIGHTBIN_C=ON \
            -DBUILD_SHARED_LIBS=$shared -DLIGHTBIN_TESTS=OFF -DLIGHTBIN_EXAMPLES=OFF -DCMAKE_INSTALL_PREFIX="$prefix" \
            -DCMAKE_INSTALL_LIBDIR=lib
        cmake --build "$work/build_$shared"
        cmake --install "$work/build_$shared"
        cmake -S "$work/user" -B "$work/user_$shared" -DCMAKE_PREFIX_PATH="$prefix"
        cmake --build "$work/user_$shared"
    } >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
    "$work/user_$shared/user"
    # shellcheck disable=SC2046  # a word a flag
    cc -std=c99 "$here/left_out.c" -o "$work/program" $(PKG_CONFIG_PATH="$prefix/lib/pkgconfig" pkg-config --cflags --libs lightbin-c) \
        -Wl,-rpath,"$prefix/lib"
    "$work/program"
    echo "shared: $shared"
done
