// SPDX-License-Identifier: MIT
// The programs of the WebGPU renderer, each compiled when it is first wanted.
import {slicing_of, wants_bounds} from './lighting.js';
import {depth_shader, frame_bindings, surface_shader} from './shading_wgsl.js';
import {BuiltLists} from './webgpu_lists.js';
import {Program} from './webgpu_parts.js';

export const picture_format = 'rgba8unorm', depth_format = 'depth32float';

export class Programs {
    #device;
    #made = new Map();

    constructor(device) {
        this.#device = device;
    }

    // Returns those of a frame: surface; glass, where the scene has some; depth and lists, glass_lists, with Z bounds.
    async that_draw(lighting, look, {method, camera: {orthographic}}, {has_spots, has_glass}) {
        const bounded = wants_bounds(method), glass = has_glass && look !== 'heat';
        const wanted = {surface: this.#surface(lighting, look, method, has_spots, false)};
        if (glass) wanted.glass = this.#surface(lighting, look, method, has_spots, true);
        if (bounded) wanted.depth = this.#once('depth', () => this.#program([[], frame_bindings], depth_shader));
        if (bounded && look !== 'every_light') {
            const kernels = for_glass => this.#once(`${method} ${orthographic} ${for_glass}`,
                () => BuiltLists.kernels(this.#device, lighting, method, orthographic, for_glass));
            wanted.lists = kernels(false);
            if (glass) wanted.glass_lists = kernels(true);
        }
        const names = Object.keys(wanted), made = await Promise.all(Object.values(wanted));
        return Object.fromEntries(names.map((name, i) => [name, made[i]]));
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
