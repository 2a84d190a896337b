// SPDX-License-Identifier: MIT
// The scenes and their lights, in WebAssembly: module/ has what it does. The large typed arrays that are handed out are
// views of the module's memory, and valid until the next call.

const array_types = {f32: Float32Array, f64: Float64Array};

/** Fetches and starts the module. Throws an Error with a sentence for the user. */
export async function load_scenes(url = 'scenes.wasm') {
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
        throw new Error('This browser is too old: its WebAssembly has no exceptions.');
    });
    memory = instance.exports.memory;
    instance.exports._initialize();
    return new Scenes(instance.exports);
}

class Scenes {
    #module;

    constructor(module) {
        this.#module = module;
    }

    /** The scene on show, none at first: scene_json() in module/exports.cpp has what it tells. */
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

    /** What a camera makes of the scene: the matrices `projection` and `view`, and the way to the `moon`. */
    look(camera, aspect, clip) {
        return this.#ask('look', {camera, aspect, clip});
    }

    /**
     * The lights as a camera sees them: `lights`, and then suns, twelve floats each, as the shaders read them; `shapes`,
     * eight floats each, as lightbin's spots are; whether one of them `has_spots`, or all are spheres; `reach`, the greatest depth of any. The shape of light `drop` is one that
     * lightbin skips.
     */
    lights(camera, seconds, drop) {
        return this.#ask('lights', {camera, seconds, drop});
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
        if (key === 'far' || key === 'reach') return value ?? Infinity;  // which JSON has not
        const type = array_types[value?.type];
        if (!type) return value;
        return value.values ? type.from(value.values) : new type(this.#module.memory.buffer, value.at, value.count);
    }
}
