// SPDX-License-Identifier: MIT
// What lightbin makes for a picture: the lists of a scene's lights, and what shaders read beside them.
import {load} from './lightbin/lightbin.js';
import {load_scenes} from './scenes.js';

// By what the page's settings call a depth method: lightbin's options.
const options = {
    none: {},
    z_bounds: {depthTest: true},
    z_bins: {slicing: 'z-bins'},
    clusters: {depthTest: true, slicing: 'clusters'},
};

// Whether a depth method wants Z bounds from a depth pre-pass.
export const wants_bounds = method => method === 'z_bounds';

// How lightbin's shader text calls the slicing of a method.
export const slicing_of = method => options[method].slicing ?? 'no-slicing';

// The options of lightbin.cullShader(), which lists on the GPU what lights() has as shapes. for_glass: it may stand
// anywhere before what is opaque.
export function cull_options(method, orthographic, has_spots, for_glass) {
    // A sphere's numbers are the first of a spot's.
    const kind = has_spots ? {kind: 'spot'} : {kind: 'sphere', stride: 8, radius: 3};
    return {language: 'wgsl', ...options[method], ...kind, orthographic, maxOnly: for_glass};
}

// How long the lists in a table of offsets and counts are.
export function list_sizes(ranges) {
    let entries = 0, longest = 0;
    for (let at = 1; at < ranges.length; at += 2) {
        entries += ranges[at];
        longest = Math.max(longest, ranges[at]);
    }
    return {entries, longest};
}

export async function load_lighting() {
    const [lightbin, scenes] = await Promise.all([load(), load_scenes()]);
    return new Lighting(lightbin, scenes);
}

// What it hands out is valid until the next call.
export class Lighting {
    #view = null;
    #binners = new Map();

    // lightbin: the package, loaded; scenes: of scenes.js
    constructor(lightbin, scenes) {
        this.lightbin = lightbin;
        this.scenes = scenes;
    }

    // What is drawn with before any light: projection, view, moon, grid, view_constants, reduce, tiles_x, tiles_y. `clip` is
    // the graphics API, 'webgl' or 'webgpu'.
    view({camera, width, height, tile_size, clip}) {
        const look = this.scenes.look(camera, width / height, clip);
        const given = {
            projection: look.projection, width, height, tileSize: tile_size,
            clipDepth: clip === 'webgpu' ? 'zero-to-one' : 'minus-one-to-one',
            origin: clip === 'webgpu' ? 'upper-left' : 'lower-left',
        };
        if (this.#view) this.#view.update(given);
        else this.#view = this.lightbin.view(given);
        return {
            ...look, grid: this.#view.gridConstants(), view_constants: this.#view.viewConstants(),
            reduce: this.#view.reduceConstants(), tiles_x: this.#view.info.tilesX, tiles_y: this.#view.info.tilesY,
        };
    }

    // The same, and the lights and their lists. z_bounds: {min, max}, and where there is glass glass_max.
    frame(settings, z_bounds = null) {
        const begin = performance.now(), view = this.view(settings), placed = this.#place(settings);
        const placed_at = performance.now(), made = this.#lists(settings, placed, z_bounds);
        const binned_at = performance.now(), lights = made.order ? in_order(placed.lights, made.order, placed.count)
            : placed.lights;
        return {
            ...view, ...made, lights, ...counts(placed),
            ms: {lights: placed_at - begin + performance.now() - binned_at, bin: binned_at - placed_at},
        };
    }

    // The same for lists that the GPU makes: what lightbin's passes read, and `plans` of them, the first for lists with
    // room for `room` entries. Where glass has lists of its own, glass_room is theirs, and the second plan.
    async gpu_frame(settings, room, glass_room = null) {
        const {method, camera: {orthographic}} = settings, clusters = slicing_of(method) === 'clusters';
        const begin = performance.now(), view = this.view(settings), placed = this.#place(settings);
        const placed_at = performance.now(), slices = this.#slices(method, settings, placed.reach);
        const plan = (entries, for_glass) => this.lightbin.planCull(this.#view,
            cull_options(method, orthographic, placed.has_spots, for_glass), {lights: placed.count, entries, slices});
        try {
            const plans = [await plan(room, false)];
            if (glass_room !== null) plans.push(await plan(glass_room, true));
            return {
                ...view, lights: placed.lights, shapes: placed.array, ...counts(placed), plans,
                slices: slices?.shaderWords() ?? new Uint32Array(0), edges: this.#view.shaderEdges(),
                slabs: clusters ? slices.shaderSlabs() : null,
                cells: view.tiles_x * view.tiles_y * (clusters ? slices.count : 1),
                ms: {lights: placed_at - begin, bin: performance.now() - placed_at},
            };
        } finally {
            slices?.dispose();
        }
    }

    // The lights of scenes.lights(), their number, and their shapes as lightbin takes them: as spots where any is one, and
    // by their spheres alone where none is, which takes less time.
    #place({camera, seconds = 0, drop = -1}) {
        const {lights, shapes: array, has_spots, reach} = this.scenes.lights(camera, seconds, drop);
        const shapes = has_spots ? {spots: {array}} : {spheres: {array, stride: 8}};
        return {lights, array, shapes, has_spots, reach, count: array.length / 8};
    }

    #binner(method, of_glass) {
        const name = `${method} ${of_glass}`;
        if (!this.#binners.has(name)) this.#binners.set(name, this.lightbin.binner(options[method]));
        return this.#binners.get(name);
    }

    // The slices of the depths that lights reach, of z-bins a thousand; null for a method that has none.
    #slices(method, {camera, slices: count = 24}, reach) {
        if (slicing_of(method) === 'no-slicing') return null;
        const last = reach < 1e30 ? reach || 1 : 1e30;  // 0: all lights are behind the eye
        if (method === 'z_bins') return this.lightbin.linearSlices({count: 1024, begin: 0, end: last});
        return camera.orthographic ? this.lightbin.linearSlices({count, begin: 0, end: last})
            : this.lightbin.exponentialSlices({count, first: last / 40, last});
    }

    #lists({method, ...settings}, {shapes, reach}, z_bounds) {
        if (!options[method]) throw new Error(`there is no method '${method}'`);
        const slices = this.#slices(method, settings, reach);
        const bounds = wants_bounds(method) ? {min: z_bounds?.min, max: z_bounds?.max} : null;
        try {
            const grid = this.#binner(method, false).bin(this.#view, shapes, {slices, bounds});
            // Glass may stand anywhere before the opaque surfaces, so with bounds it has lists of its own.
            const glass = bounds && z_bounds.glass_max
                ? this.#binner(method, true).bin(this.#view, shapes, {bounds: {max: z_bounds.glass_max}}) : grid;
            const words = slices?.shaderWords() ?? new Uint32Array(0), {ranges, ids, bins} = grid;
            return {
                ranges, ids, bins, slices: words, glass_ranges: glass.ranges, glass_ids: glass.ids,
                order: method === 'z_bins' ? grid.order : null,
                in_view: grid.lights - grid.culled - grid.rejected, rejected: grid.rejected, ...list_sizes(ranges),
            };
        } finally {
            slices?.dispose();
        }
    }
}

// The numbers of lights, and of the suns that follow them.
const counts = ({lights, count}) => ({light_count: count, sun_count: lights.length / 12 - count});

// Twelve floats of each light in the order of ids, which are ranks with z-bins; those out of view follow, then the suns.
function in_order(lights, order, count) {
    const ordered = lights.slice(), ranked = new Uint8Array(count);
    let to = 0;
    const put = light => {
        for (let i = 12 * light; i < 12 * light + 12; ++i) ordered[to++] = lights[i];
    };
    for (const light of order) {
        ranked[light] = 1;
        put(light);
    }
    for (let light = 0; light < count; ++light) if (!ranked[light]) put(light);
    return ordered;
}
