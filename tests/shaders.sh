#!/bin/sh
# Proves the generated shader text where the normal test run does not: `sh tests/shaders.sh` on Debian 12, as root or
# with sudo. OpenGL, for the lists that shaders make: those of the other APIs are compared with them, and those of random
# scenes with exact arithmetic. Vulkan under its validation layer, WebGPU by its two implementations (Chromium's Dawn and
# Firefox's wgpu, with their compilers Tint and naga), Microsoft's compilers (fxc, dxc) and Direct3D 11 under Wine.
# Installs what is missing; what can't be had is skipped, and the summary says so. Takes about half an hour.
set -eu
me=tests/shaders.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "" "" "$@"

jobs=$(nproc)
make_build_folder
out=$(pwd)/build/shaders
mkdir -p "$out"
: >"$out/summary"

# note PART WORDS: a line for now and for the summary.
note() {
    part=$1
    shift
    echo "$me: $part: $*"
    echo "  $part: $*" >>"$out/summary"
}

# have PART PACKAGES: whether the packages are there or could be installed.
have() {
    part=$1
    shift
    (install_packages "$@") && return
    note "$part" "SKIPPED, as the Debian packages are not to be had: $*"
    return 1
}

# run PART PROGRAM ARGUMENTS: runs the program once a processor, each with its share of the work, and waits.
# The last line of each tells what it did.
run() {
    part=$1
    shift
    echo "$me: $part"
    begin=$(date +%s)
    processes=
    for share in $(seq 0 $((jobs - 1))); do
        timeout 2400 "$@" "$share" "$jobs" >"$out/log.$share" 2>&1 &
        processes="$processes $!"
    done
    share=0
    verdict=passed
    said=
    for process in $processes; do
        wait "$process" || { verdict=FAILED failed=yes && cat "$out/log.$share"; }
        said="$said${said:+; }$(tail -n 1 "$out/log.$share" | tr -d '\r')"
        share=$((share + 1))
    done
    note "$part" "$verdict: $said ($(($(date +%s) - begin)) s)"
}

# keep_bytes API: keeps the hashes of the lists that the shaders of the last run made, a case and its hash a line.
keep_bytes() {
    cat "$out"/log.[0-9]* | tr -d '\r' | sed -n 's/^bytes of case \(.*\): \(.*\)$/\1 \2/p' | sort -u >"$out/bytes.$1"
}

# compare_bytes API MOST: the lists of an API are those of OpenGL, byte by byte, in all cases that it ran but at most
# MOST. A case with two hashes is a difference, too.
compare_bytes() {
    part="same lists as OpenGL's, $1"
    [ -s "$out/bytes.OpenGL" ] && [ -s "$out/bytes.$1" ] || {
        note "$part" "SKIPPED, as one of the two did not run"
        return
    }
    cases=$(cut -d ' ' -f 1 "$out/bytes.$1" | sort -u | wc -l)
    other=$(sort "$out/bytes.OpenGL" | comm -13 - "$out/bytes.$1" | cut -d ' ' -f 1 | sort -u | tr '\n' ' ')
    verdict=passed
    [ "$(echo "$other" | wc -w)" -le "$2" ] || { verdict=FAILED failed=yes; }
    note "$part" "$verdict: $cases cases, others in $(echo "$other" | wc -w) ${other:+(cases $other)}"
}

# build COMPILER SOURCE PROGRAM LIBRARIES
build() {
    compiler=$1 source=$2 program=$3
    shift 3
    # The structs of Vulkan and Direct3D are filled member by member.
    $compiler -std=c++20 -O1 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror \
        -Wno-missing-field-initializers -Iinclude "tests/shader/$source" -o "$out/$program" "$@" ||
        fail "tests/shader/$source does not compile"
}

failed=
wine_prefix=
display=
finish() {
    [ -z "$wine_prefix" ] || WINEPREFIX=$wine_prefix wineserver -k || true
    [ -z "$display" ] || kill "$display"
}
trap finish EXIT

rm -f "$out"/bytes.* "$out"/log.*
if have "OpenGL, lists" g++ libepoxy-dev libegl1 libgl1-mesa-dri; then
    echo "$me: building the OpenGL runner"
    build g++ cull_gl.cpp run_cull_gl -Iexamples/tiled_forward examples/tiled_forward/gl_context.cpp \
        examples/tiled_forward/gl_program.cpp -lepoxy
    run "OpenGL, lists" env GALLIVM_PERF=nopt "$out/run_cull_gl" 430
    keep_bytes OpenGL
fi

if have "OpenGL, random scenes" g++ libepoxy-dev libegl1 libgl1-mesa-dri libboost-dev libgmp-dev libglm-dev; then
    echo "$me: building the hunt"
    build g++ cull_hunt.cpp run_cull_hunt -DLIGHTBIN_NO_SIMD -Iexamples/tiled_forward bench/gpu/device.cpp \
        examples/tiled_forward/gl_context.cpp examples/tiled_forward/gl_program.cpp -lepoxy -lgmp
    run "OpenGL, random scenes" env GALLIVM_PERF=nopt "$out/run_cull_hunt" 10000
fi

if have Vulkan g++ glslang-dev libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers; then
    echo "$me: building the Vulkan runner"
    build g++ vulkan/run_jobs.cpp run_vulkan -lvulkan -lglslang -lMachineIndependent -lGenericCodeGen -lHLSL \
        -lOSDependent -lOGLCompiler -lSPIRV -lSPIRV-Tools-opt -lSPIRV-Tools \
        -lglslang-default-resource-limits
    mkdir -p "$out/runtime" && chmod 700 "$out/runtime"
    run Vulkan env HOME="$out" XDG_RUNTIME_DIR="$out/runtime" \
        VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json "$out/run_vulkan"
    keep_bytes Vulkan
    # Debian's Mesa draws the first of several views alone; the Vulkan in software that the browser brings draws all.
    if have "Vulkan multiview" chromium; then
        run "Vulkan multiview" env HOME="$out" XDG_RUNTIME_DIR="$out/runtime" \
            VK_ICD_FILENAMES=/usr/lib/chromium/vk_swiftshader_icd.json "$out/run_vulkan" multiview
    fi
fi

# have_npm PART PACKAGE: whether an npm package could be put into build/shaders/npm/PACKAGE. Debian's npm is installed
# only where there is none.
have_npm() {
    part=$1
    command -v npm >/dev/null || have "$part" npm || return 1
    (fetch_npm "$out/npm/$2" "$2") && return
    note "$part" "SKIPPED, as npm could not install $2"
    return 1
}

# WebGPU, and with it Microsoft's compilers for Windows.
dawn=webgpu@0.6.2
deno=deno@2.9.6

if have WGSL g++ nodejs chromium mesa-vulkan-drivers nlohmann-json3-dev; then
    echo "$me: building the writer of the jobs for WebGPU"
    build g++ webgpu/write_jobs.cpp write_wgsl_jobs
    mkdir -p "$out/runtime" && chmod 700 "$out/runtime"
    # Debian's Mesa lacks what Dawn wants; the browser brings another Vulkan in software.
    if have_npm "WGSL, Dawn" $dawn; then
        run "WGSL, Dawn" env XDG_RUNTIME_DIR="$out/runtime" \
            VK_ICD_FILENAMES=/usr/lib/chromium/vk_swiftshader_icd.json \
            node tests/shader/webgpu/run_jobs.mjs "$out" "$out/npm/$dawn/node_modules/webgpu/index.js"
        keep_bytes Dawn
    fi
    if have_npm "WGSL, naga" $deno; then
        run "WGSL, naga" env HOME="$out" DENO_NO_UPDATE_CHECK=1 XDG_RUNTIME_DIR="$out/runtime" \
            VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json \
            "$out/npm/$deno/node_modules/@deno/"linux-*-glibc/deno run -A tests/shader/webgpu/run_jobs.mjs "$out"
        keep_bytes wgpu
    fi
fi

# SwiftShader, on which Dawn runs here, makes denormal numbers zero, as Vulkan and WebGPU allow; the others compute with
# them as OpenGL does. This is the likely reason why two cases differ there.
compare_bytes Vulkan 0
compare_bytes wgpu 0
compare_bytes Dawn 2

if have Direct3D wine wine64 g++-mingw-w64-x86-64-posix xvfb libgl1-mesa-dri && have_npm Direct3D $dawn; then
    dlls=$out/npm/$dawn/node_modules/webgpu/dist/win32-x64
    cp "$dlls/d3dcompiler_47.dll" "$dlls/dxcompiler.dll" "$out"
    echo "$me: building the Direct3D programs"
    build x86_64-w64-mingw32-g++-posix d3d/compile.cpp compile.exe -static
    build x86_64-w64-mingw32-g++-posix d3d/run_jobs.cpp run_d3d11.exe -static -ld3d11

    export WINEPREFIX="$out/wine" HOME="$out" WINEDEBUG=-all
    # Wine's own d3dcompiler refuses most of HLSL.
    export WINEDLLOVERRIDES="mscoree=;mshtml=;winemenubuilder.exe=;d3dcompiler_47=n"
    wine_prefix=$WINEPREFIX
    timeout 300 wine wineboot -i >"$out/wine.log" 2>&1 || fail "Wine does not start; its log is $out/wine.log"
    run "fxc 5.0" wine "$out/compile.exe" fxc 5_0
    run "fxc 5.1" wine "$out/compile.exe" fxc 5_1
    run "dxc 6.0" wine "$out/compile.exe" dxc 6_0
    run "dxc 6.6" wine "$out/compile.exe" dxc 6_6

    rm -f "$out/display"
    Xvfb -displayfd 3 -screen 0 640x480x24 3>"$out/display" 2>/dev/null &
    display=$!
    for _ in $(seq 50); do [ -s "$out/display" ] || sleep 0.2; done
    run "Direct3D 11" env DISPLAY=:"$(cat "$out/display")" wine "$out/run_d3d11.exe"
    keep_bytes Direct3D
    compare_bytes Direct3D 0
fi

echo "$me: summary"
cat "$out/summary"
[ -z "$failed" ] || fail "not every part passed"
! grep -q SKIPPED "$out/summary" || echo "$me: what ran passed, but NOT EVERYTHING RAN"
