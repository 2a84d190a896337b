// SPDX-License-Identifier: MIT
// lightbin in WebAssembly: module/ has what it does. No copy of anything large is made: the typed arrays that are
// handed out are views of the module's memory, and valid until the next call.

const array_types = {u32: Uint32Array, f32: Float32Array, f64: Float64Array};

/** Fetches and starts the module. Throws an Error with a sentence for the user. */
export async function load(url = 'lightbin.wasm') {
    const response = await fetch(url).catch(() => null);
    if (!response?.ok) throw new Error(`${url} could not be fetched`);
    const typed = response.headers.get('content-type') === 'application/wasm';  // it can be compiled while it arrives
    return start(typed ? response : await response.arrayBuffer());
}

/** The same of a module that is there already. */
export async function start(module) {
    let memory;
    const nothing = () => 0;
    const imports = {
        env: {emscripten_notify_memory_growth: nothing},
        wasi_snapshot_preview1: {
            clock_time_get(clock, precision, at) {
                new DataView(memory.buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
                return 0;
            },
            proc_exit(code) {
                throw new Error(`the module ended with ${code}`);
            },
            // What C++'s streams are linked with.
            fd_close: nothing,
            fd_seek: nothing,
            fd_write: nothing,
            environ_get: nothing,
            environ_sizes_get: nothing,
        },
    };
    if (!globalThis.WebAssembly) throw new Error('This browser has no WebAssembly.');
    const instantiate = module instanceof Response ? 'instantiateStreaming' : 'instantiate';
    const {instance} = await WebAssembly[instantiate](module, imports).catch(() => {
        throw new Error('This browser is too old: its WebAssembly has no vectors (SIMD) or no exceptions.');
    });
    memory = instance.exports.memory;
    instance.exports._initialize();
    return new Lightbin(instance.exports);
}

class Lightbin {
    #module;

    constructor(module) {
        this.#module = module;
    }

    /** The scene on show, none at first: see scene_json() in module/exports.cpp. */
    get scene() {
        return this.#ask('scene', {});
    }

    /** Shows a made scene: 'city' with so many lights, or 'street'. */
    make(kind, lights = 1) {
        return this.#ask('make', {kind, lights});
    }

    /** Shows a binary glTF file. Throws an Error with a sentence where it cannot; the scene from before stays then. */
    open(bytes, name) {
        this.#put('data', bytes);
        return this.#ask('open', {name});
    }

    /** What is drawn with before any light: projection, view, moon, grid, shader_view, reduce, tiles_x, tiles_y. */
    view(settings) {
        return this.#ask('view', settings);
    }

    /** The same, and the lights and their lists. z_bounds: {min, max}, and where there is glass glass_max. */
    frame(settings, z_bounds = null) {
        return this.#ask_with('frame', settings, z_bounds);
    }

    /**
     * What the ways to light this view cost here, the cheapest first; with z_bounds those with depth, too, and
     * settings.z_bounds_milliseconds is what they took. Takes some hundreds of frames.
     */
    advise(settings, z_bounds = null) {
        return this.#ask_with('advise', settings, z_bounds);
    }

    /** A text that lightbin generates: 'snippet', 'reduce' or 'build'. See module/texts.cpp for the options. */
    text(what, options) {
        return this.#ask('text', {what, options});
    }

    #ask_with(what, settings, z_bounds) {
        if (!z_bounds) return this.#ask(what, settings);
        const sides = ['min', 'max', 'glass_max'].filter(side => z_bounds[side]);
        this.#put('data', ...sides.map(side => z_bounds[side]));
        const bounds = Object.fromEntries(sides.map(side => [side, z_bounds[side].length]));
        return this.#ask(what, {...settings, bounds});
    }

    #ask(what, question) {
        const spread = (key, value) => (ArrayBuffer.isView(value) ? [...value] : value);
        this.#put('question', new TextEncoder().encode(JSON.stringify(question, spread)));
        const from = this.#run(what);  // after which the memory may be another one
        const said = new Uint8Array(this.#module.memory.buffer, from, this.#module.answer_length());
        const answer = JSON.parse(new TextDecoder().decode(said), (key, value) => this.#revived(key, value));
        if (answer.error) throw new Error(answer.error);
        return answer;
    }

    // Where the answer is. What the module cannot catch itself, such as a file that is nested too deep, must not cost
    // stack.
    #run(what) {
        const stack = this.#module.stackSave();
        try {
            return this.#module[what]();
        } catch (error) {
            this.#module.stackRestore(stack);
            throw new Error(`this is too much for the browser: ${error.message}`);
        }
    }

    // Writes arrays one after another where the module reads the question, or the data beside it.
    #put(where, ...arrays) {
        const bytes = arrays.reduce((sum, array) => sum + array.byteLength, 0);
        let at = this.#module[where](bytes);
        if (bytes > 0 && at === 0) throw new Error('there is not enough memory for this');
        for (const array of arrays) {
            new array.constructor(this.#module.memory.buffer, at, array.length).set(array);
            at += array.byteLength;
        }
    }

    #revived(key, value) {
        if (key === 'far') return value ?? Infinity;  // which JSON has not
        const type = array_types[value?.type];
        if (!type) return value;
        return value.values ? type.from(value.values) : new type(this.#module.memory.buffer, value.at, value.count);
    }
}
