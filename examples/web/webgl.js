// SPDX-License-Identifier: MIT
// The WebGL 2 renderer: draw() has the frame from top to bottom.
import {slicing_of, wants_bounds} from './lighting.js';
import {depth_text, fragment_text, lights_width, overlay_text, reduce_text, vertex_text} from './shading_glsl.js';
import {FrameBuffer, Program, Texture, Timer, until_done} from './webgl_parts.js';

export class WebGl {
    name = 'WebGL 2';
    rows_from_below = true;  // of read()
    refused = {};  // depth methods that this browser cannot do, and why

    #canvas;
    #gl;
    #frame_buffer;
    #bounds_buffer;
    #timer;
    #vertices = null;
    #opaque = 0;  // vertices; those of glass follow
    #glass = 0;
    #spots = false;
    #made = new Map();  // programs and textures, by name

    static async create(canvas) {
        const gl = canvas.getContext('webgl2',
            {alpha: false, antialias: false, depth: false, powerPreference: 'high-performance'});
        if (!gl) throw new Error('This browser has no WebGL 2, or it is switched off.');
        return new WebGl(canvas, gl);
    }

    constructor(canvas, gl) {
        this.#canvas = canvas;
        this.#gl = gl;
        if (!gl.getExtension('EXT_color_buffer_float'))
            this.refused.z_bounds = 'Z bounds can\'t be had here: this WebGL 2 lacks EXT_color_buffer_float';
        this.#frame_buffer = new FrameBuffer(gl);
        this.#bounds_buffer = gl.createFramebuffer();
        this.#timer = new Timer(gl);
        gl.clearColor(0.006, 0.008, 0.014, 1);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LEQUAL);
        canvas.addEventListener('webglcontextlost', event => event.preventDefault());  // so that it may come back
    }

    get lost() {
        if (!this.#gl.isContextLost()) return null;
        return 'The browser took the graphics context away. The picture goes on when it is back.';
    }

    destroy() {
        this.#gl.getExtension('WEBGL_lose_context')?.loseContext();
    }

    set_scene(scene) {
        const gl = this.#gl;
        this.#opaque = scene.triangles.length / 9;
        this.#glass = scene.glass.length / 9;
        this.#spots = scene.has_spots;
        gl.deleteBuffer(this.#vertices);
        this.#vertices = gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, this.#vertices);
        gl.bufferData(gl.ARRAY_BUFFER, scene.triangles.byteLength + scene.glass.byteLength, gl.STATIC_DRAW);
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, scene.triangles);
        gl.bufferSubData(gl.ARRAY_BUFFER, scene.triangles.byteLength, scene.glass);
        for (const attribute of [0, 1, 2]) {  // position, normal, colour
            gl.enableVertexAttribArray(attribute);
            gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 36, 12 * attribute);
        }
    }

    async draw(lighting, settings) {
        settings = {...settings, clip: 'webgl'};
        const {method, width, height} = settings, look = settings.every_light ? 'every' : settings.look;
        const ms = {};
        let last = performance.now();
        const lap = () => -last + (last = performance.now());
        this.#frame_buffer.resize(width, height);
        const program = await this.#forward_program(lighting, look, slicing_of(method));
        if (wants_bounds(method)) await until_done(this.#gl);  // reading them would wait for the frame before, too
        lap();

        // 1. Depth alone, and from it the depths between which each tile has anything to light.
        const bounds = wants_bounds(method) ? await this.#find_bounds(lighting, settings) : null;
        ms.pre_pass = bounds === null ? 0 : lap();

        // 2. The lists: which lights can reach which tile.
        const frame = lighting.frame(settings, bounds);
        ({lights: ms.lights, bin: ms.bin} = frame.ms);
        lap();

        // 3. To the GPU. Glass may stand anywhere before the opaque surfaces, so with bounds it has lists of its own.
        const {ranges, ids, slices, bins, glass_ranges, glass_ids, tiles_x} = frame;
        this.#texture('lights', 'rgba32float').write(frame.lights, lights_width);
        this.#upload(program, 'lightbin', {tiles: ranges, lists: ids, slices, bins}, tiles_x);
        const own_lists = bounds !== null && this.#glass > 0;
        if (own_lists) this.#upload(program, 'glass', {tiles: glass_ranges, lists: glass_ids}, tiles_x);
        ms.upload = lap();

        // 4. The picture.
        this.#set_uniforms(program, frame, settings);
        const draw = () => this.#draw_triangles(program, bounds !== null, own_lists, look !== 'heat');
        this.#frame_buffer.bind();
        if (look === 'every' || look === 'check') {
            await this.#draw_in_bands(draw, settings.wanted);
            ms.draw = lap();
        } else {
            this.#timer.begin();
            draw();
            ms.draw = await this.#timer.end(settings.exact);
        }
        if (settings.show !== false) this.#frame_buffer.show(this.#canvas);
        const {in_view, rejected, entries, longest, tiles_y} = frame;
        return {ms, in_view, rejected, entries, longest, tiles_x, tiles_y, timed: this.#timer.kind};
    }

    async read() {
        const picture = this.#frame_buffer.read(), error = this.#gl.getError();
        if (error !== this.#gl.NO_ERROR) throw new Error(`WebGL reports error ${error}.`);
        return picture;
    }

    // Z bounds of the tiles. Glass is lit before the sky, too: its maximum counts the background.
    async #find_bounds(lighting, settings) {
        const gl = this.#gl, view = lighting.view(settings), {orthographic} = settings.camera;
        const reduce = await this.#reduce_program(lighting, orthographic, true);
        const reduce_glass = this.#glass > 0 ? await this.#reduce_program(lighting, orthographic, false) : null;
        const program = this.#named('depth', () => new Program(gl, vertex_text, depth_text));
        program.use();
        program.place_triangles(view);
        this.#frame_buffer.bind();
        gl.drawBuffers([gl.NONE]);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        gl.drawArrays(gl.TRIANGLES, 0, this.#opaque);
        gl.drawBuffers([gl.COLOR_ATTACHMENT0]);

        gl.disable(gl.DEPTH_TEST);
        const bounds = this.#reduce(reduce, view);
        if (reduce_glass) bounds.glass_max = this.#reduce(reduce_glass, view).max;
        gl.enable(gl.DEPTH_TEST);
        return bounds;
    }

    #reduce_program(lighting, orthographic, skipBackground) {
        return this.#named(`reduce ${orthographic} ${skipBackground}`, async () => {
            const options = {language: 'essl-300', fragment: true, orthographic, skipBackground};
            const {text} = await lighting.lightbin.reduceShader(options);
            return new Program(this.#gl, overlay_text, reduce_text(text));
        });
    }

    #reduce(program, {reduce, tiles_x, tiles_y}) {
        const gl = this.#gl;
        program.use();
        gl.uniform4uiv(program.at('lightbin_grid'), reduce.subarray(0, 4));
        gl.uniform4fv(program.at('lightbin_planes'), new Float32Array(reduce.buffer, 16, 4));
        program.bind('lightbin_depth', this.#frame_buffer.depth);
        const target = this.#texture('z_bounds', 'rg32float');
        target.reserve(tiles_x, tiles_y);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.#bounds_buffer);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target.texture, 0);
        gl.viewport(0, 0, tiles_x, tiles_y);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        const tiles = tiles_x * tiles_y, read = new Float32Array(4 * tiles);
        gl.readPixels(0, 0, tiles_x, tiles_y, gl.RGBA, gl.FLOAT, read);  // RGBA can be read everywhere
        const bounds = {min: new Float32Array(tiles), max: new Float32Array(tiles)};
        for (let tile = 0; tile < tiles; ++tile) {
            bounds.min[tile] = read[4 * tile];
            bounds.max[tile] = read[4 * tile + 1];
        }
        return bounds;
    }

    // What lightbin's text reads, by the names, formats and widths that it told. No width: a row for each tile row.
    #upload(program, prefix, lists, tiles_x) {
        for (const {name, webgpuFormat: format, width} of program.lists) {
            const numbers = lists[name.replace('lightbin_', '')];
            if (numbers) this.#texture(name.replace('lightbin', prefix), format).write(numbers, width || tiles_x);
        }
    }

    #bind_lists(program, prefix) {
        for (const {name} of program.lists) program.bind(name, this.#texture(name.replace('lightbin', prefix)).texture);
    }

    #set_uniforms(program, frame, {width, height, exposure}) {
        const gl = this.#gl;
        program.use();
        program.place_triangles(frame);
        program.bind('lights', this.#texture('lights').texture);
        gl.uniform2f(program.at('picture_size'), width, height);
        gl.uniform3fv(program.at('moon'), frame.moon);
        gl.uniform1f(program.at('exposure'), exposure);
        gl.uniform1i(program.at('light_count'), frame.light_count);
        gl.uniform1i(program.at('sun_count'), frame.sun_count);
        gl.uniform1f(program.at('longest_list'), Math.max(frame.longest, 1));
        gl.uniform4uiv(program.at('lightbin_grid'), frame.grid.slice(0, 4));
        gl.uniform4fv(program.at('lightbin_image'), frame.view_constants.slice(0, 4));
        gl.uniform4fv(program.at('lightbin_depths'), frame.view_constants.slice(4));
    }

    #draw_triangles(program, depth_is_there, glass_has_lists, with_glass) {
        const gl = this.#gl;
        gl.clear(gl.COLOR_BUFFER_BIT | (depth_is_there ? 0 : gl.DEPTH_BUFFER_BIT));
        this.#bind_lists(program, 'lightbin');
        gl.drawArrays(gl.TRIANGLES, 0, this.#opaque);
        if (!with_glass || this.#glass === 0) return;

        // 1 - (1 - glass) (1 - behind): the light of both, whatever is drawn first, and never more than white.
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_COLOR);
        gl.depthMask(false);
        if (glass_has_lists) this.#bind_lists(program, 'glass');
        gl.drawArrays(gl.TRIANGLES, this.#opaque, this.#glass);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }

    // Every light in every fragment takes long: the page lives on between bands of the picture, and no driver takes the
    // GPU to hang. It ends early when it is not wanted any more.
    async #draw_in_bands(draw, wanted = () => true) {
        const gl = this.#gl, {height} = this.#frame_buffer;
        gl.enable(gl.SCISSOR_TEST);
        for (let row = 0, rows = 8; row < height && wanted();) {
            const begun = performance.now();
            gl.scissor(0, row, this.#frame_buffer.width, rows);
            draw();
            await until_done(gl);
            row += rows;
            rows = performance.now() - begun < 60 ? 2 * rows : Math.max(rows >> 1, 1);
        }
        gl.disable(gl.SCISSOR_TEST);
    }

    #forward_program(lighting, look, slicing) {
        return this.#named(`${look} ${slicing} ${this.#spots}`, async () => {
            const check = look === 'check';
            const looks = {heatMap: look === 'heat', viewCheck: check, listCheck: check};
            const {text, bindings} = look === 'every' ? {text: '', bindings: []}
                : await lighting.lightbin.shader({language: 'essl-300', storage: 'texture-2d', slicing, ...looks});
            return new Program(this.#gl, vertex_text, fragment_text(look, text, this.#spots), bindings);
        });
    }

    #texture(name, format) {
        return this.#named('texture ' + name, () => new Texture(this.#gl, format));
    }

    #named(name, make) {
        if (!this.#made.has(name)) this.#made.set(name, make());
        return this.#made.get(name);
    }
}
