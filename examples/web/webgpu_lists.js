// SPDX-License-Identifier: MIT
// Lists made where they are read, of lights in a buffer: by the passes of lightbin.cullShader().
import {Program, Store, usages} from './webgpu_parts.js';

const bytes_of_totals = 16;

export class CulledLists {
    // Ids that there is room for. How many a scene needs is known when its lists have been made: has_room() below.
    room = 1024;

    constructor(device) {
        for (const name of ['scratch', 'tiles', 'lists', 'z_bounds'])
            this[name] = new Store(device, usages.storage);
        this.constants = new Store(device, usages.uniform);
    }

    // The passes for options of lighting.cull_options(), by their names.
    static async kernels(device, {lightbin}, options) {
        const made = await Promise.all(['project', 'count', 'sums', 'offsets', 'fill'].map(async pass =>
            [pass, await Program.for_compute(device, await lightbin.cullShader({...options, pass}))]));
        return new Map(made);
    }

    // What a plan of lighting.gpu_frame() needs.
    upload({constants, bytes}, {slabs, edges, tiles_x, tiles_y}) {
        this.constants.write(constants);
        for (const name of ['scratch', 'tiles', 'lists']) this[name].reserve(bytes[name]);
        // First the depths of the slices, or the Z bounds, which another pass writes; then the sides of the tiles.
        const edges_at = slabs ? slabs.byteLength : 8 * tiles_x * tiles_y;
        this.z_bounds.reserve(edges_at + edges.byteLength);
        if (slabs) this.z_bounds.write(slabs);
        this.z_bounds.write(edges, edges_at);
    }

    // `shared`: lightbin_lights, lightbin_slices
    encode(pass, kernels, {passes}, shared) {
        const resources = {...shared, lightbin_grid_block: this.constants, lightbin_z_bounds: this.z_bounds,
            lightbin_scratch: this.scratch, lightbin_tiles: this.tiles, lightbin_lists: this.lists};
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
