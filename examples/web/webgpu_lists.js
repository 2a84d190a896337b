// SPDX-License-Identifier: MIT
// Lists made where the depths are: lightbin's shaders reduce a depth buffer to Z bounds, and build the lists from
// those.
import {Program, Store, usages} from './webgpu_parts.js';

export class BuiltLists {
    constructor(device) {
        for (const name of ['tiles', 'lists', 'total', 'z_bounds'])
            this[name] = new Store(device, usages.storage);
        for (const name of ['reduce', 'build'])
            this[name] = new Store(device, usages.uniform);
    }

    // The shaders, in the order of their dispatches. Glass may stand anywhere before what is opaque, and before the
    // sky.
    static async kernels(device, {lightbin}, depthTest, orthographic, for_glass) {
        const language = 'wgsl', skipBackground = !for_glass, maxOnly = for_glass;
        const build = pass => lightbin.buildShader({language, pass, depthTest, maxOnly, orthographic});
        return Promise.all([
            lightbin.reduceShader({language, orthographic, skipBackground}), build('count'), build('offsets'),
            build('fill'),
        ].map(async text => Program.for_compute(device, await text)));
    }

    upload({reduce, build, edges, tiles_x, tiles_y}) {
        const tiles = tiles_x * tiles_y;
        this.reduce.write(reduce);
        this.build.write(build);
        this.tiles.reserve(8 * tiles);
        this.z_bounds.write(edges, 8 * tiles);  // the tiles' sides, which are read for box, behind their Z bounds
        this.lists.reserve(4 * build[3]);  // the most entries that there can be
        this.total.reserve(4);
    }

    // `inputs`: lightbin_depth, lightbin_footprints
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
}
