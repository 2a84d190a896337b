// SPDX-License-Identifier: MIT
// The WebGPU renderer: draw() has the frame from top to bottom.
import {list_sizes, wants_bounds} from './lighting.js';
import {frame_constants} from './shading_wgsl.js';
import {BuiltLists} from './webgpu_lists.js';
import {Store, usages} from './webgpu_parts.js';
import {Programs, depth_format, picture_format} from './webgpu_programs.js';

// What is read back of a frame: six times in nanoseconds, and the table of the tiles built here.
const tiles_at = 48;

// Cuts a picture into bands of rows that no device takes long for: [first row, rows].
function cut(width, height, lights) {
    const rows = Math.max(1, Math.floor(2e7 / (width * lights)));
    return Array.from({length: Math.ceil(height / rows)}, (_, i) => [i * rows, Math.min(rows, height - i * rows)]);
}

export class WebGpu {
    name = 'WebGPU';
    rows_from_below = false;
    refused = {};
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
    #lists;  // of interval and box
    #glass_lists;
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
        this.#lists = new BuiltLists(device);
        this.#glass_lists = new BuiltLists(device);
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
        const {width, height, method, exposure} = settings;
        const look = settings.every_light ? 'every_light' : settings.look;
        const scene = {has_spots: this.#spots, has_glass: this.#glass > 0};
        const programs = await this.#programs.that_draw(lighting, look, settings, scene);
        this.#resize(width, height);

        // 1. The lists: which lights can reach which tile. With Z bounds: what they are built of.
        const frame = lighting.frame({...settings, clip: 'webgpu', on_gpu: wants_bounds(method)});
        const {in_view, rejected, entries, longest, tiles_x, tiles_y, light_count} = frame;
        const report = {ms: {...frame.ms}, in_view, rejected, entries, longest, tiles_x, tiles_y,
            timed: this.#clock ? 'gpu' : 'wall'};

        // 2. To the GPU.
        const start = performance.now(), constants = frame_constants(frame, exposure, width, height);
        this.#upload(frame, programs);
        report.ms.upload = performance.now() - start;

        // 3. Depth, lists and picture: of the heat map once more, where its colours were not relative to the longest
        // list.
        const bands = cut(width, height, look === 'every_light' || look === 'check' ? light_count : 1);
        for (let right = false; !right;) {
            this.#store('frame', usages.uniform).write(constants(report.longest));
            const {times, built} = await this.#submit(programs, report, bands, settings.wanted);
            Object.assign(report.ms, {pre_pass: times[0], bin: frame.ms.bin + times[1], draw: times[2]});
            right = !built || look !== 'heat' || built.longest === report.longest;
            Object.assign(report, built);
        }
        if (settings.show !== false) this.#show();
        return report;
    }

    // The Z bounds of a view's tiles, and what they took.
    async bounds(lighting, settings) {
        const with_box = {...settings, method: 'box', look: 'lit', clip: 'webgpu', on_gpu: true};
        const scene = {has_spots: this.#spots, has_glass: false};
        const programs = await this.#programs.that_draw(lighting, 'lit', with_box, scene);
        this.#resize(settings.width, settings.height);
        const frame = lighting.frame(with_box), {tiles_x, tiles_y} = frame;
        this.#upload(frame, programs);
        this.#store('frame', usages.uniform).write(frame_constants(frame, 1, settings.width, settings.height)(0));
        const {times} = await this.#submit(programs, {tiles_x, tiles_y}, []);

        const encoder = this.#device.createCommandEncoder(), pairs = this.#store('bounds', usages.results);
        const bytes = 8 * tiles_x * tiles_y;
        pairs.reserve(bytes);
        encoder.copyBufferToBuffer(this.#lists.z_bounds.buffer, 0, pairs.buffer, 0, bytes);
        this.#device.queue.submit([encoder.finish()]);
        const words = new Float32Array(await pairs.read(bytes));
        const side = first => words.filter((_, i) => i % 2 === first);
        return {min: side(0), max: side(1), milliseconds: times[0]};
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

    #upload(frame, programs) {
        this.#store('grid', usages.uniform).write(frame.grid);
        this.#store('view', usages.uniform).write(frame.shader_view);
        this.#store('lights').write(frame.lights);
        if (programs.lists) {
            this.#store('footprints').write(frame.footprints);
            this.#lists.upload(frame);
            this.#glass_lists.upload(frame);
        } else {
            this.#store('tiles').write(frame.ranges);
            this.#store('lists').write(frame.ids);
            this.#store('slices').write(frame.slices);
            this.#store('bins').write(frame.bins);
        }
    }

    // Draws, band by band, as long as that is wanted. Returns the milliseconds of pre-pass, lists and picture, and of
    // the lists that were built here how long they are.
    async #submit(programs, {tiles_x, tiles_y}, bands, wanted = () => true) {
        const {queue} = this.#device, start = performance.now();
        let encoder = this.#device.createCommandEncoder();
        if (programs.depth) this.#draw_depth(encoder, programs.depth);
        if (programs.lists) this.#build_lists(encoder, programs, tiles_x, tiles_y);
        for (const [i, band] of bands.entries()) {
            const first = i === 0, last = i === bands.length - 1;
            if (!first && !last && !wanted()) continue;
            this.#draw_band(encoder, programs, band, first, last);
            if (last) break;
            queue.submit([encoder.finish()]);
            await queue.onSubmittedWorkDone();
            encoder = this.#device.createCommandEncoder();
        }

        const tiles = programs.lists ? tiles_x * tiles_y : 0, results = this.#store('results', usages.results);
        results.reserve(tiles_at + 8 * tiles);
        this.#copy_results(encoder, results.buffer, tiles);
        queue.submit([encoder.finish()]);
        const bytes = await results.read(tiles_at + 8 * tiles), wall = performance.now() - start;
        const at = Array.from(new BigUint64Array(bytes, 0, 6), nanoseconds => Number(nanoseconds) / 1e6);
        const taken = (there, first) => (there ? at[first + 1] - at[first] : 0);
        return {
            times: this.#clock ? [taken(programs.depth, 0), taken(programs.lists, 2), taken(true, 4)] : [0, 0, wall],
            built: tiles > 0 ? list_sizes(new Uint32Array(bytes, tiles_at, 2 * tiles)) : null,
        };
    }

    #draw_depth(encoder, program) {
        const pass = encoder.beginRenderPass({
            colorAttachments: [],
            depthStencilAttachment: this.#depth_attachment(true),
            timestampWrites: this.#times(0, 1),
        });
        this.#draw_vertices(pass, program, this.#resources(), 0, this.#opaque);
        pass.end();
    }

    #build_lists(encoder, programs, tiles_x, tiles_y) {
        const inputs = {
            lightbin_depth: this.#depth.createView(),
            lightbin_footprints: this.#store('footprints'),
        };
        const pass = encoder.beginComputePass({timestampWrites: this.#times(2, 3)});
        this.#lists.encode(pass, programs.lists, inputs, tiles_x, tiles_y);
        if (programs.glass_lists) this.#glass_lists.encode(pass, programs.glass_lists, inputs, tiles_x, tiles_y);
        pass.end();
    }

    #draw_band(encoder, {surface, glass, depth, lists, glass_lists}, [top, rows], first, last) {
        const pass = encoder.beginRenderPass({
            colorAttachments: [{view: this.#picture.createView(), loadOp: first ? 'clear' : 'load', storeOp: 'store'}],
            depthStencilAttachment: this.#depth_attachment(first && !depth),
            timestampWrites: this.#times(first ? 4 : undefined, last ? 5 : undefined),
        });
        pass.setScissorRect(0, top, this.#picture.width, rows);
        this.#draw_vertices(pass, surface, this.#resources(lists && this.#lists), 0, this.#opaque);
        if (glass) {
            const resources = this.#resources(glass_lists && this.#glass_lists);
            this.#draw_vertices(pass, glass, resources, this.#opaque, this.#glass);
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

    // What the names in the shaders of surfaces stand for. `built`: lists that were built here.
    #resources(built = null) {
        return {
            frame: this.#store('frame'),
            lights: this.#store('lights'),
            lightbin_grid_block: this.#store('grid'),
            lightbin_image_block: this.#store('view'),
            lightbin_tiles: built?.tiles ?? this.#store('tiles'),
            lightbin_lists: built?.lists ?? this.#store('lists'),
            lightbin_slices: this.#store('slices'),
            lightbin_bins: this.#store('bins'),
        };
    }

    #draw_vertices(pass, program, resources, first, count) {
        program.use(pass, resources);
        pass.setVertexBuffer(0, this.#store('vertices').buffer);
        pass.draw(count, 1, first);
    }

    #copy_results(encoder, results, tiles) {
        if (this.#clock) {
            const times = this.#store('times', GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC);
            times.reserve(48);
            encoder.resolveQuerySet(this.#clock, 0, 6, times.buffer, 0);
            encoder.copyBufferToBuffer(times.buffer, 0, results, 0, 48);
        }
        if (tiles > 0) encoder.copyBufferToBuffer(this.#lists.tiles.buffer, 0, results, tiles_at, 8 * tiles);
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
