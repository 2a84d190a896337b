// SPDX-License-Identifier: MIT
// lightbin for node, which reads the module from the package's folder.
import {readFile} from 'node:fs/promises';
import {hasSimd, load as load_module} from './lightbin.js';

export {LightbinError, hasSimd} from './lightbin.js';

const file = name => readFile(new URL(name, import.meta.url));

export function load(options) {
    const {simd = hasSimd(), wasm, shaders, ...others} = options ?? {};
    return load_module({simd, wasm: wasm ?? file(simd ? './lightbin_simd.wasm' : './lightbin.wasm'),
                        shaders: shaders ?? (() => file('./shaders.wasm')), ...others});
}
