#!/bin/sh
# sh packaging/npm/build.sh [FOLDER]: makes the npm package in FOLDER (default: build/npm/lightbin). Needs emscripten,
# binaryen, esbuild and node: on Debian 12 the packages emscripten, node-acorn, binaryen, esbuild and nodejs. Takes two
# minutes.
set -eu
me=packaging/npm/build.sh
cd "$(dirname "$0")/../.."
. tests/packages.sh
takes "a folder" "[^-].*" "$@"
here=packaging/npm
out=${1-build/npm/lightbin}
work=$out.work
rm -rf "$out" "$work"
mkdir -p "$out" "$work"

minify() {
    esbuild "$@" --minify --format=esm --banner:js='// SPDX-License-Identifier: MIT' --log-level=warning
}
node $here/tables.mjs include/lightbin/lightbin.h $here/lightbin.js "$work/tables.js" "$work/layouts.inl"
cp $here/lightbin.js "$work"
minify "$work/lightbin.js" --bundle --outfile="$out/lightbin.js"
minify $here/three*.js $here/playcanvas.js $here/babylon.js $here/adapters.js --outdir="$out"
cp $here/*.d.ts $here/node.js $here/README.md LICENSE "$out"
sed "s/@VERSION@/$(library_version)/" $here/package.json.in >"$out/package.json"

# module NAME FUNCTIONS FEATURES FLAG...: exports those functions that the package's JavaScript calls whose names have a
# word of FUNCTIONS, a pattern. FEATURES are flags of wasm-opt. With emscripten's own settings for -Os, no vector
# operation would be inlined.
module() {
    name=$1 functions=$2 features=$3
    shift 3
    # shellcheck disable=SC2086  # a word a flag
    NODE_PATH=/usr/share/nodejs em++ -std=c++20 -Os -sINLINING_LIMIT=0 -Wall -Wextra -Wshadow -Werror \
        -fno-exceptions -fno-rtti -DNDEBUG "$@" $left_out \
        -I "$work" -Iinclude $here/lightbin.cpp -o "$work/$name.wasm" --profiling-funcs -sSTANDALONE_WASM --no-entry \
        -sERROR_ON_UNDEFINED_SYMBOLS=0 -sWARN_ON_UNDEFINED_SYMBOLS=0 \
        -sMALLOC=emmalloc -sALLOW_MEMORY_GROWTH -sINITIAL_MEMORY=1MB -sTOTAL_STACK=128KB \
        -sEXPORTED_FUNCTIONS="$(grep -oE '\<(c|exports)\.lightbin_[a-z_]+' $here/lightbin.js | sort -u |
            grep -P "$functions" | sed 's/.*\./_/' | paste -s -d ,),_lightbin_error_text,_malloc,_free,_live_allocations"
    # shellcheck disable=SC2086  # a word a flag
    wasm-opt $features -Oz --converge -g "$work/$name.wasm" -S -o "$work/$name.wat"
    node $here/sort_functions.mjs <"$work/$name.wat" >"$work/$name.sorted.wat"
    # shellcheck disable=SC2086
    wasm-as $features "$work/$name.sorted.wat" -o "$out/$name.wasm"
}
# Modules with vectors are only loaded where there are vectors. Text, which few programs ask for, and not in each frame,
# has a module of its own.
left_out=-DLIGHTBIN_NO_SCALAR
# The second threshold is that of functions that are declared inline, whose default of 325 is made for speed alone.
small='-mllvm -inline-threshold=0 -mllvm -inlinehint-threshold=40'
small="$small -fno-vectorize -fno-slp-vectorize -fno-unroll-loops"
vectors='-msimd128 -msign-ext -mnontrapping-fptoint -mbulk-memory'
vector_features='--enable-simd --enable-sign-ext --enable-nontrapping-float-to-int --enable-bulk-memory'
text='lightbin_(view_text|shader_(snippet|text|destroy|binding)|(reduce|cull)_shader|plan_cull|dump)'
# What view_text(), plan_cull() and dump() take.
planned='view_(create|update|describe|destroy)|binner_(create|destroy)|slices_(from_boundaries|count|destroy)'
# shellcheck disable=SC2086  # a word a flag
{
    module lightbin "^(?!.*$text)" "" $small &
    module lightbin_simd "^(?!.*$text)" "$vector_features" $small $vectors
    wait $!
    module shaders "$text|$planned" "" -Oz
}

# The shader texts of the adapters for three.js and Babylon.js, whose options do not change, so that they need no module
# for that.
node --input-type=module - "$out" <<'END'
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';
const folder = path.resolve(process.argv[2]), {load} = await import(pathToFileURL(`${folder}/node.js`));
const lightbin = await load(), masks = {slicing: 'z-bins', masks: true}, language = 'essl-300';
const write = async (file, names, ...all) => {
    const texts = await Promise.all(all.map(async options =>
        (await lightbin.shader({storage: 'texture-2d', ...options})).text));
    fs.writeFileSync(`${folder}/${file}`, `export const [${names}] = ${JSON.stringify(texts)};\n`);
};
await write('three_text.js', 'lists, masks', {language, slicing: 'clusters'}, {language, ...masks});
await write('babylon_text.js', 'glsl, wgsl', {language, ...masks}, {language: 'wgsl', ...masks});
END

for name in lightbin lightbin_simd; do
    echo "$out: $name.wasm has $(stat -c %s "$out/$name.wasm") bytes; a program that loads it reads" \
        "$(for file in lightbin.js $name.wasm; do gzip -9c "$out/$file"; done | wc -c) bytes, compressed by gzip"
done
