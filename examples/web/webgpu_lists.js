// SPDX-License-Identifier: MIT
// Lists made where the depths are: lightbin's shaders reduce a depth buffer to Z bounds, and build the lists from those.
import {Program, Store, usages} from './webgpu_parts.js';

export class BuiltLists {
    #room = 1 << 16;  // for ids
    #constants;

    // `for_glass`: it may stand anywhere before what is opaque, and before the sky.
    constructor(device, for_glass) {
        this.device = device;
        this.for_glass = for_glass;
        for (const name of ['tiles', 'lists', 'total', 'z_bounds'])
            this[name] = new Store(device, usages.storage);
        for (const name of ['reduce', 'build'])
            this[name] = new Store(device, usages.uniform);
    }

    // The shaders, in the order of their dispatches.
    static async kernels(device, lightbin, depth_test, orthographic, for_glass) {
        const language = 'wgsl', max_only = for_glass;
        const reduce = lightbin.text('reduce', {language, stage: 'compute', orthographic, skip_background: !for_glass});
        const build = pass => lightbin.text('build', {language, pass, depth_test, max_only, orthographic});
        return Promise.all([reduce, build('count'), build('offsets'), build('fill')]
            .map(text => Program.for_compute(device, text)));
    }

    upload(frame) {
        const tiles = frame.tiles_x * frame.tiles_y;
        this.reduce.write(frame.reduce);
        this.#constants = Uint32Array.from(frame.build);
        this.#make_room(this.#room);
        this.total.reserve(4);
        this.tiles.reserve(8 * tiles);
        this.z_bounds.reserve(8 * tiles);
    }

    // `inputs`: lightbin_depth, lightbin_footprints, lightbin_edges
    encode(pass, [reduce, count, offsets, fill], inputs, tiles_x, tiles_y) {
        const own = {lightbin_tiles: this.tiles, lightbin_lists: this.lists, lightbin_total: this.total,
            lightbin_z_bounds: this.z_bounds};
        reduce.use(pass, {...inputs, ...own, lightbin_grid_block: this.reduce});
        pass.dispatchWorkgroups(tiles_x, tiles_y);
        for (const kernel of [count, offsets, fill]) {
            kernel.use(pass, {...inputs, ...own, lightbin_grid_block: this.build});
            if (kernel === offsets) pass.dispatchWorkgroups(1);
            else pass.dispatchWorkgroups(tiles_x, tiles_y);
        }
    }

    // Whether that many ids fit. Where they do not, the next lists will have the room.
    fits(ids) {
        const fits = ids <= this.#room;
        if (!fits) this.#make_room(Math.ceil(1.25 * ids));
        return fits;
    }

    #make_room(ids) {
        this.#room = this.#constants[3] = ids;  // ShaderBuild::room
        this.lists.reserve(4 * ids);
        this.build.write(this.#constants);
    }
}
