// SPDX-License-Identifier: MIT
// What the WebGL 2 renderer is built of: programs, textures, the picture's frame buffer, the time that drawing takes.

export class Program {
    #gl;
    #program;
    #places = new Map();
    #units = new Map();

    // lists: what lightbin.shader() says that its text wants bound.
    constructor(gl, vertex_text, fragment_text, lists = []) {
        this.#gl = gl;
        this.lists = lists.filter(binding => binding.resource === 'texture-2d');
        this.#program = gl.createProgram();
        for (const [kind, text] of [[gl.VERTEX_SHADER, vertex_text], [gl.FRAGMENT_SHADER, fragment_text]]) {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(this.#program, shader);
            gl.deleteShader(shader);
        }
        gl.linkProgram(this.#program);
        if (gl.getProgramParameter(this.#program, gl.LINK_STATUS) || gl.isContextLost()) return;
        const logs = gl.getAttachedShaders(this.#program).map(shader => gl.getShaderInfoLog(shader));
        throw new Error('A shader does not compile: ' + [gl.getProgramInfoLog(this.#program), ...logs].join(' '));
    }

    use() {
        this.#gl.useProgram(this.#program);
    }

    // The place of a uniform. Setting one that the program does not have sets nothing.
    at(name) {
        if (!this.#places.has(name)) this.#places.set(name, this.#gl.getUniformLocation(this.#program, name));
        return this.#places.get(name);
    }

    place_triangles({view, projection}) {
        this.#gl.uniformMatrix4fv(this.at('view'), false, view);
        this.#gl.uniformMatrix4fv(this.at('projection'), false, projection);
    }

    // A sampler's texture, in a unit of its own; unit 0 is for uploads.
    bind(name, texture) {
        const gl = this.#gl;
        if (!this.#units.has(name)) {
            this.#units.set(name, this.#units.size + 1);
            gl.uniform1i(this.at(name), this.#units.get(name));
        }
        gl.activeTexture(gl.TEXTURE0 + this.#units.get(name));
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.activeTexture(gl.TEXTURE0);
    }
}

// A format by WebGPU's name for it: what it is in the GPU, in memory, and numbers a texel.
const formats = {
    r32uint: ['R32UI', 'RED_INTEGER', 'UNSIGNED_INT', 1],
    rg32uint: ['RG32UI', 'RG_INTEGER', 'UNSIGNED_INT', 2],
    rg32float: ['RG32F', 'RG', 'FLOAT', 2],
    rgba32float: ['RGBA32F', 'RGBA', 'FLOAT', 4],
    depth32float: ['DEPTH_COMPONENT32F', 'DEPTH_COMPONENT', 'FLOAT', 1],
};

// A 2D texture that is read texel by texel.
export class Texture {
    #gl;
    #format;
    #width = 0;
    #rows = 0;
    texture = null;

    constructor(gl, format) {
        this.#gl = gl;
        this.#format = formats[format];
    }

    // Afterwards it is this wide, and has that many rows or more. Whether it is a new one.
    reserve(width, rows, spare = 0) {
        const gl = this.#gl;
        if (width === this.#width && rows <= this.#rows) return false;
        const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
        if (Math.max(width, rows) > most)
            throw new Error(`What the shaders read takes ${width} x ${rows} texels, and this browser has ${most} a `
                + 'side: use larger tiles, fewer lights or another depth method.');
        gl.deleteTexture(this.texture);
        this.texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        this.#width = width;
        this.#rows = Math.min(rows + spare, most);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl[this.#format[0]], width, this.#rows);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        return true;
    }

    // Row by row; the last one may be partly filled.
    write(numbers, width) {
        const gl = this.#gl, [, layout, type, channels] = this.#format;
        const texels = numbers.length / channels, full = Math.floor(texels / width), rest = texels % width;
        const rows = Math.max(full + (rest > 0), 1);
        this.reserve(width, rows, rows >> 1);  // so that a longer one finds its place
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        const put = (row, columns, count) => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, columns, count, gl[layout],
            gl[type], numbers, row * width * channels);
        if (full > 0) put(0, width, full);
        if (rest > 0) put(full, rest, 1);
    }
}

// Waits until the GPU has done what it was given. The page lives on meanwhile.
export async function until_done(gl) {
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    while (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED)
        await new Promise(resolve => setTimeout(resolve));
    gl.deleteSync(fence);
}

// The picture and its depths, of exactly the size asked for.
export class FrameBuffer {
    #gl;
    #buffer;
    #colour = null;
    #depth = null;
    width = 0;
    height = 0;

    constructor(gl) {
        this.#gl = gl;
        this.#buffer = gl.createFramebuffer();
    }

    get depth() {
        return this.#depth.texture;
    }

    resize(width, height) {
        if (width === this.width && height === this.height) return;
        const gl = this.#gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.#buffer);
        gl.deleteRenderbuffer(this.#colour);
        this.#colour = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.#colour);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.#colour);
        if (this.#depth) gl.deleteTexture(this.#depth.texture);
        this.#depth = new Texture(gl, 'depth32float');
        this.#depth.reserve(width, height);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.#depth.texture, 0);
        if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE && !gl.isContextLost())
            throw new Error(`This browser cannot draw a picture of ${width} x ${height} pixels.`);
        this.width = width;
        this.height = height;
    }

    bind() {
        this.#gl.bindFramebuffer(this.#gl.FRAMEBUFFER, this.#buffer);
        this.#gl.viewport(0, 0, this.width, this.height);
    }

    read() {
        this.bind();
        const gl = this.#gl, bytes = new Uint8Array(4 * this.width * this.height);
        gl.readPixels(0, 0, this.width, this.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        return bytes;
    }

    show(canvas) {
        const gl = this.#gl, {width, height} = this;
        if (canvas.width !== width) canvas.width = width;
        if (canvas.height !== height) canvas.height = height;
        this.bind();
        gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
        gl.clear(gl.COLOR_BUFFER_BIT);  // or Chromium does so later, as it takes the blit for no drawing
        gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    }
}

// What the GPU takes: by its own clock where the browser lets that be read, from the second drawing on a little late;
// else until it is done.
export class Timer {
    #gl;
    #clock;
    #free = [];
    #running = [];
    #begun = 0;
    #latest = null;

    constructor(gl) {
        this.#gl = gl;
        this.#clock = gl.getExtension('EXT_disjoint_timer_query_webgl2');
        this.kind = this.#clock ? 'gpu' : 'wall';
    }

    begin() {
        this.#begun = performance.now();
        if (!this.#clock) return;
        this.#running.push(this.#free.pop() ?? this.#gl.createQuery());
        this.#gl.beginQuery(this.#clock.TIME_ELAPSED_EXT, this.#running.at(-1));
    }

    // Milliseconds of the latest drawing that is known; exact: of this one.
    async end(exact) {
        if (this.#clock) this.#gl.endQuery(this.#clock.TIME_ELAPSED_EXT);
        const waits = exact || !this.#clock || this.#latest === null;
        if (waits) await until_done(this.#gl);
        if (this.#clock) this.#collect();
        return waits ? performance.now() - this.#begun : this.#latest;
    }

    #collect() {
        const gl = this.#gl, disjoint = gl.getParameter(this.#clock.GPU_DISJOINT_EXT);
        while (this.#running.length > 0 && gl.getQueryParameter(this.#running[0], gl.QUERY_RESULT_AVAILABLE)) {
            const query = this.#running.shift();
            if (!disjoint) this.#latest = gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6;
            this.#free.push(query);
        }
    }
}
