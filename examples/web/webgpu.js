// SPDX-License-Identifier: MIT
// The WebGPU renderer: draw() has the frame from top to bottom.
import {list_sizes} from './lighting.js';
import {frame_constants} from './shading_wgsl.js';
import {CulledLists} from './webgpu_lists.js';
import {Store, usages} from './webgpu_parts.js';
import {Programs, depth_format, picture_format} from './webgpu_programs.js';

// What is read back of a frame: six times in nanoseconds; four words each of what the lists and those of glass came to;
// and the table of tiles.
const totals_at = 48, glass_totals_at = 64, tiles_at = 80;

// Cuts a picture into bands of rows that no device takes long for: [first row, rows].
function cut(width, height, lights) {
    const rows = Math.max(1, Math.floor(2e7 / (width * lights)));
    return Array.from({length: Math.ceil(height / rows)}, (_, i) => [i * rows, Math.min(rows, height - i * rows)]);
}

export class WebGpu {
    name = 'WebGPU';
    rows_from_below = false;
    refused = {z_bins: 'Z-bins can\'t be had in WebGPU: the GPU makes the lists there, of tiles and of clusters'};
    lost = null;  // a sentence, when the device is

    static async create(canvas) {
        const adapter = await navigator.gpu?.requestAdapter({powerPreference: 'high-performance'});
        if (!adapter) throw new Error('This browser has no WebGPU, or it is switched off.');
        const {maxBufferSize, maxStorageBufferBindingSize} = adapter.limits;
        const device = await adapter.requestDevice({
            requiredFeatures: ['timestamp-query'].filter(feature => adapter.features.has(feature)),
            requiredLimits: {maxBufferSize, maxStorageBufferBindingSize},
        });
        return new WebGpu(canvas, device);
    }

    #canvas;
    #context;
    #device;
    #clock = null;  // where the device tells the time
    #picture = null;
    #depth = null;
    #stores = new Map();
    #programs;
    #lists;
    #glass_lists;  // with Z bounds
    #longest = 0;  // of the lists last made: what the heat map's colours are relative to
    #opaque = 0;  // vertices of what is opaque; those of glass follow
    #glass = 0;
    #spots = false;

    constructor(canvas, device) {
        this.#canvas = canvas;
        this.#device = device;
        this.#context = canvas.getContext('webgpu');
        this.#context.configure({device, format: picture_format, usage: GPUTextureUsage.COPY_DST, alphaMode: 'opaque'});
        if (device.features.has('timestamp-query')) this.#clock = device.createQuerySet({type: 'timestamp', count: 6});
        this.#programs = new Programs(device);
        this.#lists = new CulledLists(device);
        this.#glass_lists = new CulledLists(device);
        device.lost.then(({message}) => this.lost ??= `The graphics device was lost. ${message}`);
        device.addEventListener('uncapturederror', ({error}) => this.lost ??= `WebGPU reports: ${error.message}`);
    }

    destroy() {
        this.#device.destroy();
    }

    set_scene(scene) {
        this.#opaque = scene.triangles.length / 9;
        this.#glass = scene.glass.length / 9;
        this.#spots = scene.has_spots;
        const vertices = this.#store('vertices', usages.vertices);
        vertices.reserve(scene.triangles.byteLength + scene.glass.byteLength);
        vertices.write(scene.triangles);
        vertices.write(scene.glass, scene.triangles.byteLength);
    }

    // One at a time. Resolves when the device has drawn: what it reports is of this very frame.
    async draw(lighting, settings) {
        try {
            return await this.#draw(lighting, settings);
        } catch (error) {
            throw this.lost ? new Error(this.lost) : error;
        }
    }

    async #draw(lighting, settings) {
        const {width, height, method} = settings;
        const look = settings.every_light ? 'every_light' : settings.look;
        const scene = {has_spots: this.#spots, has_glass: this.#glass > 0};
        const programs = await this.#programs.that_draw(lighting, look, settings, scene);
        const all_lists = programs.glass_lists ? [this.#lists, this.#glass_lists] : [this.#lists];
        this.#resize(width, height);
        for (;;) {
            // 1. The lights, and the plan of the passes that make the lists: which lights can reach which tile.
            const frame = await lighting.gpu_frame({...settings, clip: 'webgpu'}, ...all_lists.map(({room}) => room));
            const {tiles_x, tiles_y, light_count} = frame;

            // 2. To the GPU.
            const start = performance.now(), of_heat = this.#longest;
            this.#upload(frame, settings);
            this.#store('lights').write(frame.lights);
            this.#store('shapes').write(frame.shapes);
            this.#store('slices').write(frame.slices);
            all_lists.forEach((lists, i) => lists.upload(frame.plans[i], frame));
            const upload = performance.now() - start;

            // 3. Depth, lists and picture.
            const bands = cut(width, height, look === 'every_light' || look === 'check' ? light_count : 1);
            const {times, totals, longest} = await this.#submit(programs, frame, bands, settings.wanted);
            this.#longest = longest;

            // 4. Once more, before it is shown, where a list was cut, or colours are relative to another list.
            const had_room = all_lists.map((lists, i) => lists.has_room(totals[i].entries));
            if (had_room.includes(false) || (look === 'heat' && longest !== of_heat)) continue;
            if (settings.show !== false) this.#show();
            const {lights, bin} = frame.ms;
            return {
                ms: {pre_pass: times[0], lights, bin: bin + times[1], upload, draw: times[2]},
                ...totals[0], longest, tiles_x, tiles_y, timed: this.#clock ? 'gpu' : 'wall',
            };
        }
    }

    #resize(width, height) {
        if (this.#picture?.width === width && this.#picture.height === height) return;
        this.#picture?.destroy();
        this.#depth?.destroy();
        const {RENDER_ATTACHMENT, COPY_SRC, TEXTURE_BINDING} = GPUTextureUsage, size = [width, height];
        const texture = (format, usage) => this.#device.createTexture({size, format, usage});
        this.#picture = texture(picture_format, RENDER_ATTACHMENT | COPY_SRC);
        this.#depth = texture(depth_format, RENDER_ATTACHMENT | TEXTURE_BINDING);
    }

    #store(name, usage = usages.storage) {
        if (!this.#stores.has(name)) this.#stores.set(name, new Store(this.#device, usage));
        return this.#stores.get(name);
    }

    // What places the triangles.
    #upload(view, settings) {
        this.#store('frame', usages.uniform).write(frame_constants(view, settings, this.#longest));
        this.#store('grid', usages.uniform).write(view.grid);
        this.#store('view', usages.uniform).write(view.view_constants);
        this.#store('reduce', usages.uniform).write(view.reduce);
    }

    // Draws, band by band, as long as that is wanted. Returns the milliseconds of pre-pass, lists and picture; what the
    // lists came to, {entries, rejected, in_view} each; and how long the longest is.
    async #submit(programs, frame, bands, wanted = () => true) {
        const {queue} = this.#device, start = performance.now();
        let encoder = this.#device.createCommandEncoder();
        if (programs.depth) this.#find_bounds(encoder, programs, frame);
        this.#make_lists(encoder, programs, frame);
        for (const [i, band] of bands.entries()) {
            const first = i === 0, last = i === bands.length - 1;
            if (!first && !last && !wanted()) continue;
            this.#draw_band(encoder, programs, band, first, last);
            if (last) break;
            queue.submit([encoder.finish()]);
            await queue.onSubmittedWorkDone();
            encoder = this.#device.createCommandEncoder();
        }

        const results = this.#store('results', usages.results), end = tiles_at + 8 * frame.cells;
        results.reserve(end);
        this.#copy_results(encoder, programs, results.buffer, end);
        queue.submit([encoder.finish()]);
        const bytes = await results.read(end), wall = performance.now() - start;
        const at = Array.from(new BigUint64Array(bytes, 0, 6), nanoseconds => Number(nanoseconds) / 1e6);
        const taken = first => at[first + 1] - at[first];
        return {
            times: this.#clock ? [programs.depth ? taken(0) : 0, taken(2), taken(4)] : [0, 0, wall],
            totals: [totals_at, glass_totals_at].map(from => {
                const [entries, rejected, in_view] = new Uint32Array(bytes, from, 3);
                return {entries, rejected, in_view};
            }),
            longest: list_sizes(new Uint32Array(bytes, tiles_at)).longest,
        };
    }

    // Depth alone, and from it the depths between which each tile has anything to light.
    #find_bounds(encoder, {depth, reduce, glass_reduce}, {tiles_x, tiles_y}) {
        this.#draw_depth(encoder, depth);
        const pass = encoder.beginComputePass({timestampWrites: this.#times(undefined, 1)});
        const reduce_to = (program, {z_bounds}) => {
            program.use(pass, {
                lightbin_depth: this.#depth.createView(), lightbin_grid_block: this.#store('reduce'),
                lightbin_z_bounds: z_bounds,
            });
            pass.dispatchWorkgroups(tiles_x, tiles_y);
        };
        reduce_to(reduce, this.#lists);
        if (glass_reduce) reduce_to(glass_reduce, this.#glass_lists);
        pass.end();
    }

    #draw_depth(encoder, program) {
        const pass = encoder.beginRenderPass({
            colorAttachments: [],
            depthStencilAttachment: this.#depth_attachment(true),
            timestampWrites: this.#times(0, undefined),
        });
        this.#draw_vertices(pass, program, {frame: this.#store('frame')}, 0, this.#opaque);
        pass.end();
    }

    #make_lists(encoder, {lists, glass_lists}, {plans}) {
        const shared = {lightbin_lights: this.#store('shapes'), lightbin_slices: this.#store('slices')};
        const pass = encoder.beginComputePass({timestampWrites: this.#times(2, 3)});
        this.#lists.encode(pass, lists, plans[0], shared);
        if (glass_lists) this.#glass_lists.encode(pass, glass_lists, plans[1], shared);
        pass.end();
    }

    #draw_band(encoder, {surface, glass, depth, glass_lists}, [top, rows], first, last) {
        const pass = encoder.beginRenderPass({
            colorAttachments: [{view: this.#picture.createView(), loadOp: first ? 'clear' : 'load', storeOp: 'store'}],
            depthStencilAttachment: this.#depth_attachment(first && !depth),
            timestampWrites: this.#times(first ? 4 : undefined, last ? 5 : undefined),
        });
        pass.setScissorRect(0, top, this.#picture.width, rows);
        this.#draw_vertices(pass, surface, this.#resources(this.#lists), 0, this.#opaque);
        if (glass) {
            const lists = glass_lists ? this.#glass_lists : this.#lists;
            this.#draw_vertices(pass, glass, this.#resources(lists), this.#opaque, this.#glass);
        }
        pass.end();
    }

    #depth_attachment(clear) {
        const depthLoadOp = clear ? 'clear' : 'load';
        return {view: this.#depth.createView(), depthClearValue: 1, depthLoadOp, depthStoreOp: 'store'};
    }

    #times(beginningOfPassWriteIndex, endOfPassWriteIndex) {
        const wanted = this.#clock && (beginningOfPassWriteIndex ?? endOfPassWriteIndex) !== undefined;
        return wanted ? {querySet: this.#clock, beginningOfPassWriteIndex, endOfPassWriteIndex} : undefined;
    }

    // What the names in the shaders of surfaces stand for.
    #resources({tiles, lists}) {
        return {
            frame: this.#store('frame'), lights: this.#store('lights'),
            lightbin_grid_block: this.#store('grid'), lightbin_image_block: this.#store('view'),
            lightbin_tiles: tiles, lightbin_lists: lists, lightbin_slices: this.#store('slices'),
        };
    }

    #draw_vertices(pass, program, resources, first, count) {
        program.use(pass, resources);
        pass.setVertexBuffer(0, this.#store('vertices').buffer);
        pass.draw(count, 1, first);
    }

    #copy_results(encoder, {glass_lists}, results, end) {
        if (this.#clock) {
            const times = this.#store('times', GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC);
            times.reserve(48);
            encoder.resolveQuerySet(this.#clock, 0, 6, times.buffer, 0);
            encoder.copyBufferToBuffer(times.buffer, 0, results, 0, 48);
        }
        this.#lists.copy_totals(encoder, results, totals_at);
        if (glass_lists) this.#glass_lists.copy_totals(encoder, results, glass_totals_at);
        encoder.copyBufferToBuffer(this.#lists.tiles.buffer, 0, results, tiles_at, end - tiles_at);
    }

    #show() {
        const encoder = this.#device.createCommandEncoder(), {width, height} = this.#picture;
        if (this.#canvas.width !== width) this.#canvas.width = width;
        if (this.#canvas.height !== height) this.#canvas.height = height;
        const canvas = {texture: this.#context.getCurrentTexture()};
        encoder.copyTextureToTexture({texture: this.#picture}, canvas, [width, height]);
        this.#device.queue.submit([encoder.finish()]);
    }

    // The last picture as RGBA.
    async read() {
        const {width, height} = this.#picture, row = 256 * Math.ceil(width / 64);  // a copy's rows begin at such places
        const pixels = this.#store('pixels', usages.results);
        pixels.reserve(row * height);
        const encoder = this.#device.createCommandEncoder();
        const target = {buffer: pixels.buffer, bytesPerRow: row};
        encoder.copyTextureToBuffer({texture: this.#picture}, target, [width, height]);
        this.#device.queue.submit([encoder.finish()]);
        const padded = new Uint8Array(await pixels.read(row * height)), bytes = new Uint8Array(4 * width * height);
        for (let y = 0; y < height; y++) bytes.set(padded.subarray(row * y, row * y + 4 * width), 4 * width * y);
        return bytes;
    }
}
