// SPDX-License-Identifier: MIT
// Lists made where they are read, of lights in a buffer: by the passes of lightbin.cullShader().
import {Program, Store, usages} from './webgpu_parts.js';

const bytes_of_totals = 16;

export class CulledLists {
    // Ids that there is room for. How many a scene needs is known when its lists have been made: has_room() below.
    room = 1024;

    constructor(device) {
        for (const name of ['scratch', 'tiles', 'lists', 'order', 'bins', 'z_bounds'])
            this[name] = new Store(device, usages.storage);
        this.constants = new Store(device, usages.uniform);
    }

    // The passes for options of lighting.cull_options(), by their names.
    static async kernels(device, {lightbin}, options) {
        const passes = ['project', 'count', 'sums', 'offsets', 'fill'];
        if (options.slicing === 'z-bins') passes.splice(1, 0, 'bin-counts', 'bin-offsets', 'rank', 'masks');
        const made = await Promise.all(passes.map(async pass =>
            [pass, await Program.for_compute(device, await lightbin.cullShader({...options, pass}))]));
        return new Map(made);
    }

    // What a plan of lighting.gpu_frame() needs.
    upload({constants, bytes}, {slabs, edges, tiles_x, tiles_y}) {
        this.constants.write(constants);
        for (const [name, size] of Object.entries(bytes)) this[name].reserve(size);
        // First the depths of the slices, or the Z bounds, which another pass writes; then the sides of the tiles.
        const edges_at = slabs ? slabs.byteLength : 8 * tiles_x * tiles_y;
        this.z_bounds.reserve(edges_at + edges.byteLength);
        if (slabs) this.z_bounds.write(slabs);
        this.z_bounds.write(edges, edges_at);
    }

    // `shared`: lightbin_lights, lightbin_slices
    encode(pass, kernels, {passes}, shared) {
        const resources = {...shared, lightbin_grid_block: this.constants, lightbin_z_bounds: this.z_bounds,
            lightbin_scratch: this.scratch, lightbin_tiles: this.tiles, lightbin_lists: this.lists,
            lightbin_order: this.order, lightbin_bins: this.bins};
        for (const {pass: name, x, y} of passes) {
            kernels.get(name).use(pass, resources);
            pass.dispatchWorkgroups(x, y);
        }
    }

    // Copies what the lists came to, to be read back.
    copy_totals(encoder, results, at) {
        encoder.copyBufferToBuffer(this.scratch.buffer, 0, results, at, bytes_of_totals);
    }

    // Whether the lists had room for all of their entries. If not, they were cut, and next time there is more room.
    has_room(entries) {
        if (entries <= this.room) return true;
        this.lists.reserve(4 * entries);
        this.room = this.lists.buffer.size / 4;
        return false;
    }
}

// With z-bins ids are ranks. So that shaders need not know, this sorts the lights by rank; those out of view follow.
const ranked_text = `
struct Light { numbers : array<vec4f, 3> }
@group(0) @binding(0) var<storage, read> totals : array<u32>;  // the third: how many have a rank; the fourth: all
@group(0) @binding(1) var<storage, read> order : array<u32>;
@group(0) @binding(2) var<storage, read> lights : array<Light>;
@group(0) @binding(3) var<storage, read_write> ranked : array<Light>;
// How many have no rank and have been placed, and for each light whether it has a rank.
@group(0) @binding(4) var<storage, read_write> placed : array<atomic<u32>>;

@compute @workgroup_size(64) fn place_ranked(@builtin(global_invocation_id) at : vec3u) {
    if (at.x < totals[2]) {
        ranked[at.x] = lights[order[at.x]];
        atomicStore(&placed[1 + order[at.x]], 1);
    }
}

@compute @workgroup_size(64) fn place_others(@builtin(global_invocation_id) at : vec3u) {
    if (at.x < totals[3] && atomicLoad(&placed[1 + at.x]) == 0) {
        ranked[totals[2] + atomicAdd(&placed[0], 1)] = lights[at.x];
    }
}
`;
const ranked_bindings = ['lightbin_scratch', 'lightbin_order', 'lights', 'ranked', 'placed'].map((name, binding) =>
    ({name, slot: {binding}, resource: binding < 3 ? 'storage-buffer' : 'writable-buffer'}));

export class RankedLights {
    constructor(device) {
        for (const name of ['ranked', 'placed']) this[name] = new Store(device, usages.storage);
    }

    static kernels(device) {
        return Promise.all(['place_ranked', 'place_others'].map(entry =>
            Program.for_compute(device, {text: ranked_text, bindings: ranked_bindings}, entry)));
    }

    // Suns keep their places behind the lights.
    upload({lights, light_count}) {
        this.ranked.reserve(lights.byteLength);
        this.ranked.write(lights.subarray(12 * light_count), 48 * light_count);
        this.placed.reserve(4 + 4 * light_count);
    }

    clear(encoder) {
        encoder.clearBuffer(this.placed.buffer);
    }

    encode(pass, kernels, lights, {scratch, order}, light_count) {
        for (const kernel of kernels) {
            kernel.use(pass, {lights, ranked: this.ranked, placed: this.placed, lightbin_scratch: scratch,
                lightbin_order: order});
            pass.dispatchWorkgroups(Math.ceil(light_count / 64));
        }
    }
}
