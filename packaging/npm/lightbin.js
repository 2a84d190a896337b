// SPDX-License-Identifier: MIT
// lightbin for JavaScript. lightbin.d.ts describes what is exported. The names c.lightbin_... below are the functions
// that the build exports from the module, and tables.js has the structs that they take.
import {enums, structs} from './tables.js';

export class LightbinError extends Error {
    constructor(message, code) {
        super(message);
        this.name = 'LightbinError';
        this.code = code;
    }
}

const error_names = Object.fromEntries(Object.entries(enums.error).map(([name, number]) => [number, name]));
const refuse = (message, code = 'not-a-value') => { throw new LightbinError(message, code); };
const out_of_memory = () => refuse('there is not enough memory', 'out-of-memory');

// The address of an object in the module's memory, what ends it, and the Core whose memory that is.
const address = Symbol('address'), release = Symbol('release'), owner = Symbol('owner');

/// Returns the number of bytes that are to be taken of the module's memory, which has less than 2^31.
const checked_size = bytes => bytes <= 0x7fffffff ? bytes : out_of_memory();

const shown = value => Object(value) === value ? 'an object' : String(value);

const real = (number, what) => typeof number === 'number' ? number : refuse(`${what}: ${shown(number)} is no number`);

const reals = given => Object.entries(given).map(([what, number]) => real(number, what));

/// type  int32_t, or another for numbers without a sign
const whole = (number, what, type = 'int32_t') => {
    const [least, greatest] = type === 'int32_t' ? [-0x80000000, 0x7fffffff] : [0, 0xffffffff];
    return Number.isInteger(number) && number >= least && number <= greatest ? number
        : refuse(`${what}: ${shown(number)} is no whole number ${least < 0 ? 'of 32 bits' : `from 0 to ${greatest}`}`);
};

const is_array = array => typeof array === 'object' && Number.isInteger(array?.length) && array.length >= 0;

/// Refuses an array whose first `count` elements are not all numbers. Of typed arrays one tells.
function all_numbers(array, count, what) {
    const checked = Floats.made(array) ? 0 : ArrayBuffer.isView(array) ? Math.min(count, 1) : count;
    for (let i = 0; i < checked; ++i)
        if (typeof array[i] !== 'number') refuse(`${what}: element ${i} is no number`);
}

/// Refuses what is no object, which an array is not, and an object that has another property than `known`.
function only(given, known, what) {
    if (typeof given !== 'object' || given === null || is_array(given))
        refuse(`${what} must be an object of ${known.join(', ')}`);
    for (const key in given)
        if (!known.includes(key)) refuse(`${what}: there is no '${key}', but ${known.join(', ')}`);
    return given;
}

// The names of the members of each struct that a program may give.
const names = Object.fromEntries(Object.entries(structs).map(([name, {members}]) =>
    [name, Object.keys(members).filter(key => key !== 'size')]));

const moved = 'what was read of the module\'s memory before that grew is empty: read it anew after each call';

/// What a program holds of a module's memory. Its address is 0 in none that may be used.
class Held {
    #name;
    #at = 0;
    constructor(core, name) {
        this[owner] = core;
        this.#name = name;
    }
    /// Whether an object is one of this class, and no Proxy of one, which has no private members.
    static made(object) { return object instanceof this && #at in object; }
    get [address]() {
        return this.#at !== 0 ? this.#at : refuse(`${this.#name}: it was disposed of`, 'null-argument');
    }
    set [address](at) { this.#at = at; }
    /// The address, which is 0 from then on.
    [release]() {
        const at = this.#at;
        this.#at = 0;
        return at;
    }
}

// The attributes of each kind of light: the number of floats, and the place in a light that has no other given.
const kinds = {
    spheres: {stride: 4, attributes: {centre: [3, 0], radius: [1, 3]}},
    spots: {stride: 8, attributes: {centre: [3, 0], radius: [1, 3], axis: [3, 4], cosine: [1, 7]}},
    boxes: {stride: 16, attributes: {centre: [3, 0], radius: [1, 3], boxCentre: [3, 4], halfAxes: [9, 7], taper: [1]}},
};
const light_names = ['viewMatrix', 'layout', 'eye', ...Object.keys(kinds)];
for (const kind of Object.values(kinds)) kind.names = ['count', 'array', 'stride', ...Object.keys(kind.attributes)];

/// The module's functions and memory.
class Core {
    constructor(exports) {
        this.c = exports;
        this.heap();
        this.staging = new Block(this);
        this.staged = new Map();  // arrays that the call reads, and where addresses in them are to be written
    }

    /// Calls body() and gives back what it took from the module's stack, also after an error.
    scope(body) {
        const top = this.c.stackSave();
        this.staged.clear();
        try {
            return body(this.c);
        } finally {
            this.c.stackRestore(top);
        }
    }

    /// Calls a function that returns a lightbin_result, and throws if it refuses.
    check(called, ...given) {
        const {c} = this, result = c.stackAlloc(structs.result.bytes);
        called(result, ...given);
        const error = this.heap().getInt32(result, true);
        if (error === 0) return;
        const text = c.stackAlloc(512);
        c.lightbin_error_text(result, text, 512);
        refuse(this.text(text), error_names[error]);
    }

    /// Calls a function that makes an object, and returns the object's address.
    create(called, ...given) {
        const out = this.c.stackAlloc(4);
        this.check(called, ...given, out);
        return this.heap().getUint32(out, true);
    }

    /// The module's memory, which is another buffer each time it grows.
    heap() {
        const {buffer} = this.c.memory;
        if (this.data?.buffer !== buffer) {
            this.data = new DataView(buffer);
            this.bytes = new Uint8Array(buffer);
        }
        return this.data;
    }

    /// An array over the module's memory: `before` if that still is it.
    array(Type, at, length, before) {
        const {buffer} = this.c.memory;
        return before?.buffer === buffer && before.byteOffset === at && before.length === length
            ? before : new Type(buffer, at, length);
    }

    text(at) {
        const bytes = new Uint8Array(this.c.memory.buffer, at);
        return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
    }

    /// Takes memory for a struct from the stack, unless it is given some, and writes an object's properties to the
    /// members of their names.
    place(name, given, what, at = this.c.stackAlloc(structs[name].bytes)) {
        const {bytes, members} = structs[name], heap = this.heap();
        this.bytes.fill(0, at, at + bytes);
        if (members.size !== undefined) heap.setUint32(at, bytes, true);
        if (given !== undefined) this.write(name, at, given, what);
        return at;
    }

    write(name, to, given, what) {
        const {members} = structs[name], heap = this.heap();
        only(given, names[name], what);
        for (const key in given) {
            const value = given[key];
            if (value === undefined) continue;
            const [kind, offset, more] = members[key], at = to + offset;
            if (kind === 'struct') {
                this.write(more, at, value, `${what}.${key}`);
            } else if (kind === 'double') {
                heap.setFloat64(at, real(value, `${what}.${key}`), true);
            } else if (more !== undefined) {
                if (typeof value !== 'string' || !Object.hasOwn(enums[more], value))
                    refuse(`${what}.${key}: '${shown(value)}' is none of ${Object.keys(enums[more]).join(', ')}`);
                heap.setInt32(at, enums[more][value], true);
            } else {
                heap.setInt32(at, whole(typeof value === 'boolean' ? +value : value, `${what}.${key}`, kind), true);
            }
        }
    }

    /// Adds the members of a struct to an object, and returns it.
    read(name, from, values = {}) {
        const heap = this.heap(), {members} = structs[name];
        for (const key in members) {
            const [kind, offset, more] = members[key], at = from + offset;
            values[key] = kind === 'float' ? heap.getFloat32(at, true) : kind === 'double' ? heap.getFloat64(at, true)
                : kind === 'struct' ? this.read(more, at) : kind === 'int32_t' ? heap.getInt32(at, true)
                : heap.getUint32(at, true);
            if (kind === 'int32_t' && more !== undefined) values[key] = Object.keys(enums[more])[values[key]];
            if (kind === 'uint64_t') values[key] += heap.getUint32(at + 4, true) * 2 ** 32;
        }
        return values;
    }

    /// Writes the address of an array's float at `offset` to `to`: now if it is in the module's memory, else in
    /// flush(), which copies the first `end` floats.
    stage(array, what, to, offset, end) {
        if (Floats.made(array)) {
            if (array[owner] !== this) this.stage(array.array, what, to, offset, end);
            else this.heap().setUint32(to, array[address] + 4 * offset, true);
        } else if (array instanceof Float32Array && array.buffer === this.c.memory.buffer) {
            this.heap().setUint32(to, array.byteOffset + 4 * offset, true);
        } else {
            const use = this.staged.get(array) ?? {what, places: [], end: 0};
            use.places.push([to, offset]);
            use.end = Math.max(use.end, end);
            this.staged.set(array, use);
        }
    }

    /// Copies the arrays of the call that are not in the module's memory.
    flush() {
        if (this.staged.size === 0) return;
        let length = 0;
        for (const {end} of this.staged.values()) length += end;
        checked_size(4 * length);
        for (const [array, use] of this.staged) use.part = this.part(array, use.end, use.what);
        const begin = this.staging.reserve(4 * length);
        const floats = new Float32Array(this.c.memory.buffer, begin, length), heap = this.heap();
        let at = 0;
        for (const {part, places, end} of this.staged.values()) {
            if (end > 0 && ArrayBuffer.isView(part)) floats.set(part, at);
            else for (let i = 0; i < end; ++i) floats[at + i] = part[i];
            for (const [to, offset] of places) heap.setUint32(to, begin + 4 * (at + offset), true);
            at += end;
        }
    }

    /// The first `end` elements of an array, to be copied: where it is no typed array it is returned whole.
    part(array, end, what) {
        all_numbers(array, end, what);
        if (!ArrayBuffer.isView(array)) return array;
        try {
            const part = array.subarray(0, end);
            return array.buffer === this.c.memory.buffer ? Float32Array.from(part) : part;  // which growth would empty
        } catch (error) {
            refuse(`${what}: the array can't be copied (${error.message}); ${moved}`);
        }
    }

    /// Copies numbers to the stack as doubles, which JavaScript's numbers are.
    doubles(numbers, count, what) {
        if (!(is_array(numbers) && numbers.length >= count)) refuse(`${what} must be an array of ${count} numbers`);
        all_numbers(numbers, count, what);
        const at = this.c.stackAlloc(8 * count), heap = this.heap();
        for (let i = 0; i < count; ++i) heap.setFloat64(at + 8 * i, numbers[i], true);
        return at;
    }

    /// A lightbin_matrix as an object to write.
    matrix(numbers, layout, what) { return {doubles: this.doubles(numbers, 16, what), layout}; }

    lights(given, what = 'lights') {
        const {viewMatrix, layout, eye} = only(given, light_names, what);
        const at = this.place('lights', {
            viewMatrix: viewMatrix == null ? undefined : this.matrix(viewMatrix, layout, `${what}.viewMatrix`),
            eye: eye == null ? 0 : this.doubles(eye, 3, `${what}.eye`),
        });
        for (const kind in kinds)
            if (given[kind] != null)
                this.kind(kind, given[kind], at + structs.lights.members[kind][1], `${what}.${kind}`,
                    eye == null ? [] : ['centre', 'boxCentre']);
        return at;
    }

    /// in_double  the attributes that must be Float64Arrays
    kind(kind, given, to, what, in_double) {
        const {attributes, stride: usual, names: known} = kinds[kind], {members} = structs[kind];
        only(given, known, what);
        const {array: shared, stride = usual} = given, heap = this.heap();
        if (!(Number.isInteger(stride) && stride > 0))
            refuse(`${what}.stride: ${shown(stride)} is no number of floats`);
        if (shared !== undefined && !is_array(shared)) refuse(`${what}.array must be an array of floats`);
        const {count = this.countOf(kind, given, stride)} = given;
        heap.setUint32(to, whole(count, `${what}.count`, 'size_t'), true);
        for (const key in attributes) {
            const [floats, usual_offset] = attributes[key];
            const value = given[key] === undefined && shared !== undefined ? usual_offset : given[key];
            if (value == null) continue;
            const wide = in_double.includes(key);
            if (wide && !(value instanceof Float64Array))
                refuse(`${what}.${key}: with an eye it must be a Float64Array of three numbers a light`);
            const by_offset = typeof value === 'number', from = by_offset ? shared : value;
            const offset = by_offset ? value : 0, step = by_offset ? stride : floats;
            if (!(Number.isInteger(offset) && offset >= 0 && is_array(from)))
                refuse(`${what}.${key} must be an array of floats, or the place of the floats in each light `
                    + `of ${what}.array`);
            if (by_offset && offset + floats > stride)
                refuse(`${what}.${key}: a light has ${stride} floats, and these end at ${offset + floats}`,
                    'stride-too-small');
            const end = count > 0 ? (count - 1) * step + offset + floats : 0, at = to + members[key][1];
            if (end > from.length)
                refuse(`${what}.${key}: the array has ${from.length} floats, and ${count} lights have more`
                    + (from.length === 0 ? `; ${moved}` : ''), 'buffer-too-small');
            const name = `${what}.${by_offset ? 'array' : key}`;
            if (given.count === undefined && from.length !== count * step) {
                all_numbers(from, from.length, name);
                refuse(`${name}: the array has ${from.length} floats, and ${count} lights have ${count * step}; if `
                    + 'there are so many lights, give count');
            }
            // The bytes of doubles are copied as those of twice as many floats.
            if (wide && end > 0)
                this.stage(new Float32Array(from.buffer, from.byteOffset, 2 * end), name, at, 0, 2 * end);
            else
                this.stage(from, name, at, offset, end);
            heap.setUint32(at + 4, (wide ? 8 : 4) * step, true);
        }
    }

    countOf(kind, {array, ...given}, stride) {
        const [key, [floats]] = Object.entries(kinds[kind].attributes).find(([key]) => given[key] != null) ?? ['', [1]];
        const [of, step] = array !== undefined ? [array, stride] : [given[key], floats];
        return is_array(of) ? Math.floor(of.length / step) : 0;
    }

    /// The address of a view or of slices; 0, which the library refuses, for null.
    addressOf(object, Type, what) {
        if (object != null && !(Type.made(object) && object[owner] === this))
            refuse(`${what} was not made by this module`);
        return object?.[address] ?? 0;
    }

    inputs(given = {}) {
        const {slices, bounds} = only(given, ['slices', 'bounds'], 'inputs');
        return this.place('inputs', {
            slices: slices == null ? 0 : this.addressOf(slices, Slices, 'inputs.slices'),
            bounds: bounds == null ? 0 : this.bounds(bounds, 'inputs.bounds'),
        }, 'inputs');
    }

    bounds(given, what) {
        const bounds = Object.entries(only(given, ['min', 'max'], what)).filter(([, array]) => array != null);
        for (const [key, array] of bounds)
            if (!is_array(array)) refuse(`${what}.${key} must be an array of floats`);
        const tiles = bounds.length > 0 ? Math.min(...bounds.map(([, array]) => array.length)) : 0;
        const at = this.place('zBounds', {tiles}, what);
        for (const [key, array] of bounds)
            this.stage(array, `${what}.${key}`, at + structs.zBounds.members[key][1], 0, tiles);
        return at;
    }

    /// Returns what `called` writes of a view or slices: an array of `length` words, `words` of them an item.
    items(Type, length, words, called, from) {
        const block = new Block(this);
        try {
            return this.scope(() => {
                const at = block.reserve(4 * length);
                this.check(called, from, at, length / words);
                return this.copy(Type, at, 4 * length);
            });
        } finally {
            block.free();
        }
    }

    /// Copies `bytes` bytes of the module's memory.
    copy(Type, at, bytes) { return new Type(this.c.memory.buffer.slice(at, at + bytes)); }
}

/// Memory of the module that grows and loses its contents then.
class Block {
    constructor(core) {
        this.core = core;
        this.at = this.bytes = 0;
    }
    reserve(bytes) {
        if (checked_size(bytes) <= this.bytes) return this.at;
        this.free();
        this.at = this.core.c.malloc(bytes);
        this.bytes = bytes;
        return this.at;
    }
    free() {
        this.core.c.free(this.at);
        this.at = this.bytes = 0;
    }
}

class Floats extends Held {
    #array;
    constructor(core, length) {
        super(core, 'floats');
        this.#take(length, this.#allocate(length));
        this.array.fill(0);
    }
    get array() { return this.#array = this[owner].array(Float32Array, this[address], this.length, this.#array); }
    resize(length) {
        const before = this[address], at = this.#allocate(length);
        const array = new Float32Array(this[owner].c.memory.buffer, at, length);
        array.set(this.array.subarray(0, length));
        array.fill(0, this.length);
        this[owner].c.free(before);
        this.#take(length, at);
    }
    #allocate(length) {
        if (!(Number.isInteger(length) && length >= 0)) refuse(`length: ${shown(length)} is no number of floats`);
        return this[owner].c.malloc(checked_size(Math.max(4 * length, 4)));
    }
    /// Nobody else sets the length, by which `array` would exceed its memory.
    #take(length, at) {
        Object.defineProperty(this, 'length', {value: length, configurable: true, enumerable: true});
        this[address] = at;
    }
    dispose() {
        this[owner].c.free(this[release]());
        this.#take(0, 0);
    }
}

class View extends Held {
    #core;
    #options = {};
    constructor(core, options) {
        super(core, 'view');
        this.#core = core;
        this.#set(options, (c, at) => { this[address] = core.create(c.lightbin_view_create, at); });
    }
    /// The same view in another module.
    static copy(core, view) {
        if (!View.made(view)) refuse('view must be one of this package');
        return view[address] && new View(core, view.#options);
    }
    update(options) {
        const at = this[address];
        this.#set(options, (c, given) => this.#core.check(c.lightbin_view_update, at, given));
    }
    #set(options, call) {
        only(options, [...names.viewOptions, 'layout'], 'options');
        const core = this.#core, merged = {...this.#options, ...options}, {projection, layout, ...others} = merged;
        for (const side of ['width', 'height'])
            if (merged[side] === undefined) refuse(`options.${side} is missing: give the viewport's in pixels`);
        core.scope(c => {
            const matrix = core.matrix(projection, layout, 'options.projection');
            const at = core.place('viewOptions', {...others, projection: matrix}, 'options');
            call(c, at);
            const info = core.place('viewInfo');
            core.check(c.lightbin_view_describe, this[address], info);
            this.info = core.read('viewInfo', info);
            delete this.info.size;
            this.#options = {...merged, projection: core.copy(Float64Array, matrix.doubles, 128)};
        });
    }
    project(point) { return this.#moved(this.#core.c.lightbin_view_project, point, 'point'); }
    unproject(image) { return this.#moved(this.#core.c.lightbin_view_unproject, image, 'image'); }
    #moved(called, from, what) {
        const core = this.#core;
        return core.scope(c => {
            const given = core.doubles(from, 3, what), to = c.stackAlloc(24);
            core.check(called, this[address], given, to);
            return [...core.copy(Float64Array, to, 24)];
        });
    }
    depths(lower, upper) {
        const core = this.#core;
        return core.scope(c => {
            const to = c.stackAlloc(8);
            core.check(c.lightbin_view_depths, this[address], ...reals({lower, upper}), to);
            return [...core.copy(Float32Array, to, 8)];
        });
    }
    windowDepth(image) {
        const core = this.#core;
        return core.scope(c => c.lightbin_view_window_depth(this[address], core.doubles(image, 3, 'image')));
    }
    gridConstants(corner_x = 0, corner_y = 0) {
        return this.#constants(Uint32Array, 'gridConstants', this.#core.c.lightbin_get_grid_constants,
                               whole(corner_x, 'cornerX'), whole(corner_y, 'cornerY'));
    }
    viewConstants(tolerance = 2) {
        return this.#constants(Float32Array, 'viewConstants', this.#core.c.lightbin_get_view_constants,
                               real(tolerance, 'tolerance'));
    }
    reduceConstants(corner_x = 0, corner_y = 0) {
        return this.#constants(Uint32Array, 'reduceConstants', this.#core.c.lightbin_get_reduce_constants,
                               whole(corner_x, 'cornerX'), whole(corner_y, 'cornerY'));
    }
    shaderEdges() {
        const core = this.#core, {tilesX, tilesY} = this.info;
        return core.items(Float32Array, 2 * (tilesX + tilesY), 2, core.c.lightbin_shader_edges, this[address]);
    }
    #constants(Type, struct, called, ...given) {
        const core = this.#core;
        return core.scope(() => {
            const at = core.place(struct);
            core.check(called, this[address], ...given, at);
            return core.copy(Type, at, structs[struct].bytes);
        });
    }
    dispose() {
        this.#core.c.lightbin_view_destroy(this[release]());
        this.#options = {};
    }
}

class Slices extends Held {
    #core;
    #margin;
    constructor(core, margin, made) {
        super(core, 'slices');
        this.#core = core;
        this.#margin = real(margin, 'margin');
        this[address] = core.scope(made);
        this.count = core.c.lightbin_slices_count(this[address]);
    }
    /// The same slices in another module.
    static copy(core, slices, what) {
        if (!Slices.made(slices)) refuse(`${what} must be slices of this package`);
        return slices_of(core, slices.boundaries, slices.#margin);
    }
    get boundaries() {
        const core = this.#core, at = core.c.lightbin_slices_boundaries(this[address]);
        return at === 0 ? new Float32Array(0) : core.copy(Float32Array, at, 4 * (this.count - 1));
    }
    at(depth) { return this.#core.c.lightbin_slices_at(this[address], real(depth, 'depth')); }
    shaderWords() {
        const core = this.#core;
        return core.items(Uint32Array, this.count + 3, 1, core.c.lightbin_shader_slices, this[address]);
    }
    shaderSlabs() {
        const core = this.#core;
        return core.items(Float32Array, 2 * this.count, 2, core.c.lightbin_shader_slabs, this[address]);
    }
    dispose() {
        this.#core.c.lightbin_slices_destroy(this[release]());
        this.count = 0;
    }
}

function slices_of(core, boundaries, margin = 0) {
    if (!is_array(boundaries)) refuse('boundaries must be an array of depths');
    return new Slices(core, margin, c => {
        const at = c.stackAlloc(4);
        core.stage(boundaries, 'boundaries', at, 0, boundaries.length);
        core.flush();
        const from = core.heap().getUint32(at, true);
        return core.create(c.lightbin_slices_from_boundaries, from, boundaries.length, margin);
    });
}

// The members of structs that are arrays: which member has the number of items, and of how many numbers an item is.
const array_of = {
    ranges: ['rangeCount', 2], ids: ['idCount', 1], order: ['orderCount', 1], bins: ['binCount', 2],
    words: ['wordCount', 1],
};
const zeros = struct => Object.fromEntries(names[struct].map(key => [key, 0]));
const nothing = {grid: {...zeros('grid'), idBytes: 4}, masks: zeros('masks')};
const raw = Symbol('what the module wrote'), array = Symbol('an array of it'), made_with = Symbol('the options');

/// What a binner's call made, read from the module's memory.
class Made {
    #core;
    #own;
    #arrays = {};
    #texels = {};
    constructor(core, struct) {
        this.#core = core;
        this.#own = names[struct].filter(key => !(key in array_of || key.endsWith('Count')));
        this.set(nothing[struct]);
    }
    /// Takes what a Binner read: all members of the struct.
    set(read) {
        if (read === this[raw]) return this;
        this[raw] = read;
        for (const key of this.#own) this[key] = read[key];
        return this;
    }
    get ids() { return this[array]('ids', this.idBytes === 2 ? Uint16Array : Uint32Array); }
    get bins() { return this[array]('bins'); }
    [array](key, Type = Uint32Array) {
        const read = this[raw], [count, numbers] = array_of[key];
        return this.#arrays[key] = this.#core.array(Type, read[key], numbers * read[count], this.#arrays[key]);
    }
    texels(name, columns) {
        const from = Object.hasOwn(array_of, name) ? this[name] : refuse(`name: ${shown(name)} is not ${Object.keys(array_of).join(', ')}`);
        if (from === undefined) refuse(`name: masks have no ${name}, and lists no words`);
        const channels = array_of[name][1], width = Math.max(whole(columns, 'width', 'uint32_t'), 1);
        const rows = Math.max(Math.ceil(from.length / (channels * width)), 1);
        const height = name === 'ranges' ? rows : 2 ** Math.ceil(Math.log2(rows));
        let data = this.#texels[name];
        if (data?.length !== channels * width * height || data.constructor !== from.constructor)
            data = this.#texels[name] = new from.constructor(channels * width * height);
        data.set(from);
        return {data, width, height};
    }
}

class Masks extends Made {
    get words() { return this[array]('words'); }
}

class Lists extends Made {
    #core;
    #encoded;
    constructor(core, encoded) {
        super(core, 'grid');
        this.#core = core;
        this.#encoded = encoded;
    }
    get ranges() { return this[array]('ranges'); }
    get order() { return this[array]('order'); }
    encode(format) {
        const core = this.#core, {size, ...members} = this[raw];
        return core.scope(c => {
            const from = core.place('format', format, 'format'), grid = core.place('grid', members, 'grid');
            const encoded = core.place('encoded');
            core.check(c.lightbin_encode, grid, from, 0, 0n, encoded);
            const {bytes} = core.read('encoded', encoded), to = this.#encoded.reserve(bytes);
            core.check(c.lightbin_encode, grid, from, to, BigInt(bytes), encoded);
            const {tilesCut, entriesCut, capacityNeeded} = core.read('encoded', encoded);
            return {data: new Uint8Array(c.memory.buffer, to, bytes), tilesCut, entriesCut, capacityNeeded};
        });
    }
    append(...others) {
        const core = this.#core, grids = [this, ...others];
        for (const grid of others) {
            if (!(Object(grid) === grid && #core in grid && grid.#core === core))
                refuse('append: a grid was not made by this module');
            if (grid.idBytes !== this.idBytes)
                refuse(`append: the ids of one grid have ${this.idBytes} bytes, those of another ${grid.idBytes}`);
            if (['tilesX', 'tilesY', 'slices'].some(key => grid[raw][key] !== this[raw][key]))
                refuse('append: the grids must have the same numbers of columns and rows of tiles and of slices: give '
                    + 'their views the same viewport and tile size, and bin with the same slices', 'grids-differ');
        }
        if (new Set(grids).size < grids.length)
            refuse('append: a grid is given twice; each view needs the grid of a binner of its own');
        const sum = key => grids.reduce((sum, grid) => sum + grid[raw][key], 0);
        const rangeCount = sum('rangeCount'), idCount = sum('idCount');
        const to = this.#encoded.reserve(8 * rangeCount + this[raw].idBytes * idCount), {buffer} = core.c.memory;
        const all = {ranges: new Uint32Array(buffer, to, 2 * rangeCount),
                     ids: new this.ids.constructor(buffer, to + 8 * rangeCount, idCount)};
        let at = 0, offset = 0;
        for (const {ranges, ids} of grids) {
            for (let i = 0; i < ranges.length; i += 2) {
                all.ranges[at++] = offset + ranges[i];
                all.ranges[at++] = ranges[i + 1];
            }
            all.ids.set(ids, offset);
            offset += ids.length;
        }
        return all;
    }
}

class Binner extends Held {
    #core;
    #encoded;
    #grid;
    #masks;
    constructor(core, options) {
        super(core, 'binner');
        this.#core = core;
        this.#encoded = new Block(core);
        this.#grid = new Lists(core, this.#encoded);
        this.#masks = new Masks(core, 'masks');
        this.#grid[made_with] = this.#masks[made_with] = kept(options);
        this[address] = core.scope(c => core.create(c.lightbin_binner_create,
            core.place('binnerOptions', options, 'options')));
    }
    bin(...given) { return this.#call(this.#core.c.lightbin_bin, 'grid', this.#grid, ...given); }
    masks(...given) { return this.#call(this.#core.c.lightbin_bin_masks, 'masks', this.#masks, ...given); }
    #call(called, struct, made, view, lights, inputs) {
        const core = this.#core;
        this.#forget();
        return core.scope(() => {
            const placed = core.lights(lights), others = core.inputs(inputs), at = core.place(struct);
            core.flush();
            core.check(called, this[address], core.addressOf(view, View, 'view'), placed, others, at);
            return made.set(core.read(struct, at));
        });
    }
    dispose() {
        this.#core.c.lightbin_binner_destroy(this[release]());
        this.#encoded.free();
        this.#forget();
    }
    #forget() {
        this.#grid.set(nothing.grid);
        this.#masks.set(nothing.masks);
    }
}

// What makes shader text in the second module, its options, and their slots with the default bindings.
const snippet = {make: c => c.lightbin_shader_snippet, options: 'snippetOptions',
                 bindings: {tiles: 0, lists: 1, grid: 2, slices: 3, bins: 4, view: 5}};
const reduce = {make: c => c.lightbin_reduce_shader, options: 'reduceOptions',
                bindings: {depth: 0, zBounds: 1, grid: 2}};
const cull = {make: c => c.lightbin_cull_shader, options: 'cullOptions',
              bindings: {lights: 0, zBounds: 0, scratch: 1, slices: 2, tiles: 2, lightCount: 3, lists: 3, grid: 4}};

function shader_options(core, generator, options) {
    const {options: struct, bindings} = generator, c = core.c;
    only(options, [...names[struct].filter(key => key !== 'slotsGiven' && !Object.hasOwn(bindings, key)), 'slots'],
        'options');
    const {prefix, slots, ...others} = options, given = {...others, language: others.language ?? null};
    if (generator === snippet && given.format !== undefined)  // elsewhere it is an enum's value
        given.format = core.place('format', given.format, 'options.format');
    if (prefix !== undefined) {
        // The library refuses ' ', and more than 1000 characters.
        const text = typeof prefix === 'string' ? prefix.slice(0, 1001).replaceAll('\0', ' ') : ' ';
        const bytes = new TextEncoder().encode(text + '\0');
        given.prefix = c.stackAlloc(bytes.length);
        new Uint8Array(c.memory.buffer).set(bytes, given.prefix);
    }
    if (slots !== undefined) {
        only(slots, Object.keys(bindings), 'options.slots');
        for (const [name, binding] of Object.entries(bindings)) given[name] = slots[name] ?? {binding};
        given.slotsGiven = 1;
    }
    return core.place(struct, given, 'options');
}

function shader_text(core, generator, options) {
    const c = core.c, shader = core.create(generator.make(c), shader_options(core, generator, options));
    try {
        const bindings = [];
        for (let i = 0; i < c.lightbin_shader_binding_count(shader); ++i) {
            const at = core.place('binding');
            core.check(c.lightbin_shader_binding, shader, i, at);
            const {size, name, webgpuFormat, ...others} = core.read('binding', at);
            bindings.push({name: core.text(name), ...others, webgpuFormat: core.text(webgpuFormat)});
        }
        return {text: core.text(c.lightbin_shader_text(shader)), bindings};
    } finally {
        c.lightbin_shader_destroy(shader);
    }
}

/// A copy of what a call was given, for one that waits before it reads it. Views and slices are not copied.
const kept = value => Floats.made(value) ? value.array.slice() : is_array(value) ? value.slice?.() ?? Array.from(value)
    : Object(value) !== value || value instanceof Held ? value
    : Object.fromEntries(Object.entries(value).map(([key, of]) => [key, kept(of)]));

/// A copy of what a binner's call made: the struct's name, its members and arrays, and the binner's options.
function copy_of(made) {
    const {size, ...members} = made[raw], arrays = {};
    for (const key in array_of)
        if (key in members) arrays[key] = (key === 'ids' ? made.ids : made[array](key)).slice();
    return {struct: made instanceof Masks ? 'masks' : 'grid', options: made[made_with], members, arrays};
}

/// The text of a frame. All that is given is copied for the call.
///
/// lists  what copy_of() returned
function dump_text(core, {struct, options, members, arrays}, view, lights, inputs) {
    const block = new Block(core), to = new Block(core);
    let binner = 0;
    try {
        return core.scope(c => {
            let at = block.reserve(Object.values(arrays).reduce((sum, array) => sum + array.byteLength + 3, 0));
            for (const [key, array] of Object.entries(arrays)) {
                new array.constructor(c.memory.buffer, at, array.length).set(array);
                members[key] = at;
                at += array.byteLength + 3 & ~3;
            }
            binner = core.create(c.lightbin_binner_create, core.place('binnerOptions', options, 'options'));
            const placed = core.lights(lights), others = core.inputs(inputs);
            const lists = core.place(struct, members, struct);
            const given = [binner, view[address], placed, others, ...struct === 'grid' ? [lists, 0] : [0, lists]];
            const size = c.stackAlloc(4);
            core.flush();
            core.check(c.lightbin_dump, ...given, 0, 0, size);
            const bytes = core.heap().getUint32(size, true), text = to.reserve(bytes);
            core.check(c.lightbin_dump, ...given, text, bytes, size);
            return core.text(text);
        });
    } finally {
        core.c.lightbin_binner_destroy(binner);
        block.free();
        to.free();
    }
}

/// What the passes of cullShader() need for a view. The view and the slices are copied for the call.
function cull_plan(core, view, options, room) {
    only(room, ['lights', 'entries', 'slices', 'viewMatrix', 'layout'], 'room');
    const {lights, entries, slices, viewMatrix, layout} = room;
    const copies = [View.copy(core, view)];
    try {
        if (slices != null) copies.push(Slices.copy(core, slices, 'slices'));
        return core.scope(c => {
            const {members} = structs.cullPlan, names = Object.keys(enums.cullPass);
            const at = core.place('cullPlan'), placed = shader_options(core, cull, options);
            const to_view = viewMatrix == null ? 0
                : core.place('matrix', core.matrix(viewMatrix, layout, 'viewMatrix'), 'viewMatrix');
            core.check(c.lightbin_plan_cull, copies[0][address], placed, whole(lights, 'lights', 'uint32_t'),
                whole(entries, 'entries', 'uint32_t'), copies[1]?.[address] ?? 0, to_view, at);
            const {scratchBytes, tileBytes, listBytes, maskBytes, masksSuit} = core.read('cullPlan', at);
            const groups = core.copy(Uint32Array, at + members.groups[1], 8 * names.length);
            const all = names.map((pass, i) => ({pass, x: groups[2 * i], y: groups[2 * i + 1]}));
            return {
                constants: core.copy(Uint32Array, at + members.constants[1], 256),
                bytes: {scratch: scratchBytes, tiles: tileBytes, lists: listBytes, masks: maskBytes},
                passes: all.slice(0, -1), maskPasses: [all[0], all.at(-1)], masksSuit: masksSuit === 1,
            };
        });
    } finally {
        for (const made of copies) made.dispose();
    }
}

class Lightbin {
    #core;
    #cores;
    #load_shaders;
    #shaders;
    constructor(exports, module, simd, load_shaders) {
        this.#core = new Core(exports);
        this.#cores = [this.#core];
        this.#load_shaders = load_shaders;
        this.module = module;
        this.simd = simd;
        const version = exports.lightbin_version();
        this.version = [version / 10000, version / 100 % 100, version % 100].map(Math.floor).join('.');
    }
    view(options) { return new View(this.#core, options); }
    binner(options) { return new Binner(this.#core, options); }
    floats(length) { return new Floats(this.#core, length); }
    exponentialSlices(options) {
        return this.#slices(this.#core.c.lightbin_slices_exponential, options, 'first', 'last');
    }
    linearSlices(options) { return this.#slices(this.#core.c.lightbin_slices_linear, options, 'begin', 'end'); }
    #slices(called, options, ...ends) {
        const {count, margin = 0} = only(options, ['count', ...ends, 'margin'], 'options'), core = this.#core;
        return new Slices(core, margin, () => core.create(called, whole(count, 'count'),
            ...ends.map(end => real(options[end], end)), margin));
    }
    slicesFromBoundaries(options) {
        const {boundaries, margin = 0} = only(options, ['boundaries', 'margin'], 'options');
        return slices_of(this.#core, boundaries, margin);
    }
    shader(options) { return this.#text(snippet, options); }
    reduceShader(options) { return this.#text(reduce, options); }
    cullShader(options) { return this.#text(cull, options); }
    async planCull(view, options, room) {
        return cull_plan(await this.#shader_core(), view, options, room);
    }
    async #text(generator, options) {
        const core = await this.#shader_core();
        return core.scope(() => shader_text(core, generator, options));
    }
    #shader_core() {
        return this.#shaders ??= this.#load_shaders().then(exports => this.#cores[1] = new Core(exports))
            .catch(error => {
                this.#shaders = undefined;  // the next call tries again
                throw error;
            });
    }
    async viewText(view) {
        const core = await this.#shader_core(), copy = View.copy(core, view);
        try {
            return core.scope(c => {
                const size = c.lightbin_view_text(copy[address], 0, 0) + 1, text = c.stackAlloc(size);
                c.lightbin_view_text(copy[address], text, size);
                return core.text(text);
            });
        } finally {
            copy.dispose();
        }
    }
    async dump(made, view, lights, inputs = {}) {
        if (!(made instanceof Made) || made[raw] === nothing.grid || made[raw] === nothing.masks)
            refuse('dump: this is no grid and no masks of a binner that has made nothing since');
        const own = this.#core, {slices, ...others} = only(kept(inputs), ['slices', 'bounds'], 'inputs');
        const lists = copy_of(made), given = kept(lights), copies = [];
        const copied = (core, view, slices) => {
            copies.push(View.copy(core, view));
            if (slices != null) copies.push(Slices.copy(core, slices, 'inputs.slices'));
            return copies.slice(slices != null ? -2 : -1);
        };
        try {
            const before = copied(own, view, slices), core = await this.#shader_core();
            const [in_core, slices_in_core] = copied(core, ...before);
            return dump_text(core, lists, in_core, given, {...others, slices: slices_in_core});
        } finally {
            for (const copy of copies) copy.dispose();
        }
    }
    lightRange(intensity, cutoff) { return this.#core.c.lightbin_light_range(...reals({intensity, cutoff})); }
    get allocations() {
        const live = ({c, staging}) => c.live_allocations() - (staging.at !== 0 ? 1 : 0);
        return this.#cores.reduce((sum, core) => sum + live(core), 0);
    }
}

// A function that returns a vector of 128 bits: i32.const 0, i8x16.splat.
const vectors = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0,
    253, 15, 11);
export const hasSimd = () => WebAssembly.validate(vectors);

async function compile(wasm) {
    const source = await (typeof wasm === 'function' ? wasm() : wasm);
    if (source instanceof WebAssembly.Module) return source;
    const isAddress = typeof source === 'string' || source instanceof URL;
    const response = isAddress ? await fetch(source) : source;
    if (!(typeof Response === 'function' && response instanceof Response)) return WebAssembly.compile(response);
    if (!response.ok) refuse(`the module could not be loaded: ${response.status} ${response.url}`, 'not-loaded');
    return WebAssembly.compile(await response.arrayBuffer());
}

async function instantiate(module) {
    const {exports} = await WebAssembly.instantiate(module, {
        Math,
        env: {out_of_memory, emscripten_notify_memory_growth: () => {}},
        wasi_snapshot_preview1: {proc_exit: out_of_memory},  // of abort(), where a size exceeds all memory
    });
    exports._initialize?.();
    return exports;
}

export async function load(options = {}) {
    const {simd = hasSimd(), wasm, shaders} = only(options, ['simd', 'wasm', 'shaders'], 'options');
    const module = await compile(wasm ?? (simd ? new URL('./lightbin_simd.wasm', import.meta.url)
                                               : new URL('./lightbin.wasm', import.meta.url)));
    const load_shaders = async () => instantiate(await compile(shaders ?? new URL('./shaders.wasm', import.meta.url)));
    return new Lightbin(await instantiate(module), module, simd, load_shaders);
}
