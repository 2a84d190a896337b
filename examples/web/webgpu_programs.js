// SPDX-License-Identifier: MIT
// The programs of the WebGPU renderer, each compiled when it is first wanted.
import {cull_options, slicing_of, wants_bounds} from './lighting.js';
import {depth_shader, frame_bindings, surface_shader} from './shading_wgsl.js';
import {CulledLists} from './webgpu_lists.js';
import {Program} from './webgpu_parts.js';

export const picture_format = 'rgba8unorm', depth_format = 'depth32float';

// Waits for each property that is a promise.
async function all(promises) {
    const made = await Promise.all(Object.values(promises));
    return Object.fromEntries(Object.keys(promises).map((name, i) => [name, made[i]]));
}

export class Programs {
    #device;
    #made = new Map();

    constructor(device) {
        this.#device = device;
    }

    // Returns those of a frame: surface; glass, where the scene has some; lists; with Z bounds depth, reduce and
    // glass_reduce, glass_lists.
    that_draw(lighting, look, {method, camera: {orthographic}}, {has_spots, has_glass}) {
        const bounded = wants_bounds(method), glass = has_glass && look !== 'heat';
        const lists = for_glass => this.#lists(lighting, cull_options(method, orthographic, has_spots, for_glass));
        return all({
            surface: this.#surface(lighting, look, method, has_spots, false),
            glass: glass && this.#surface(lighting, look, method, has_spots, true),
            lists: lists(false),
            depth: bounded && this.#depth(),
            reduce: bounded && this.#reduce(lighting, orthographic, false),
            glass_reduce: bounded && glass && this.#reduce(lighting, orthographic, true),
            glass_lists: bounded && glass && lists(true),
        });
    }

    #lists(lighting, options) {
        return this.#once(JSON.stringify(options), () => CulledLists.kernels(this.#device, lighting, options));
    }

    #depth() {
        return this.#once('depth', () => this.#program([[], frame_bindings.slice(0, 1)], depth_shader));
    }

    // Glass may stand before the sky, too: its bounds count the background.
    #reduce({lightbin}, orthographic, for_glass) {
        const options = {language: 'wgsl', orthographic, skipBackground: !for_glass};
        return this.#once(`reduce ${orthographic} ${for_glass}`,
            async () => Program.for_compute(this.#device, await lightbin.reduceShader(options)));
    }

    #once(name, make) {
        if (!this.#made.has(name)) this.#made.set(name, make());
        return this.#made.get(name);
    }

    #surface(lighting, look, method, has_spots, glass) {
        const slicing = slicing_of(method), check = look === 'check';
        return this.#once(`${look} ${slicing} ${has_spots} ${glass}`, async () => {
            const {text, bindings} = look === 'every_light' ? {text: '', bindings: []}
                : await lighting.lightbin.shader(
                    {language: 'wgsl', slicing, heatMap: look === 'heat', viewCheck: check, listCheck: check});
            // 1 - (1 - glass) (1 - behind): the light of both, whatever is drawn first, and never more than white.
            const add = {srcFactor: 'one', dstFactor: 'one-minus-src'};
            const target = {format: picture_format, blend: glass ? {color: add, alpha: add} : undefined};
            return this.#program([bindings, frame_bindings], surface_shader(look, text, has_spots), target, !glass);
        });
    }

    #program(groups, text, target = null, depthWriteEnabled = true) {
        const module = this.#device.createShaderModule({code: text});
        const attributes = [0, 1, 2].map(i => ({shaderLocation: i, offset: 12 * i, format: 'float32x3'}));
        return Program.for_surfaces(this.#device, groups, {
            vertex: {module, buffers: [{arrayStride: 36, attributes}]},
            fragment: target ? {module, targets: [target]} : undefined,
            depthStencil: {format: depth_format, depthWriteEnabled, depthCompare: 'less-equal'},
        });
    }
}
