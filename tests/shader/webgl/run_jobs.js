// SPDX-License-Identifier: MIT
// Runs what write_jobs wrote, in WebGL 2.

// Returns what is wrong, or ''.
function run(job) {
    const unhex = text => Uint8Array.from(text.match(/../g) ?? [], pair => parseInt(pair, 16));
    const gl = (globalThis.gl ??= document.createElement('canvas').getContext('webgl2'));
    if (!gl) return 'there is no WebGL 2';
    const program = gl.createProgram();
    const multiview = job.views > 1 && gl.getExtension('OVR_multiview2');
    if (job.views > 1 && !multiview) return 'there is no multiview';
    const vertex = `#version 300 es
${multiview ? `#extension GL_OVR_multiview2 : require\nlayout(num_views = ${job.views}) in;` : ''}
void main() {
    gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0);
}`;
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, job.text]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) return 'refused: ' + gl.getShaderInfoLog(shader);
        gl.attachShader(program, shader);
        gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return 'not linked: ' + gl.getProgramInfoLog(program);
    gl.useProgram(program);
    const made = [() => gl.deleteProgram(program)];
    const finish = verdict => {
        made.forEach(undo => undo());
        const error = gl.getError();
        return error ? 'OpenGL error ' + error : verdict;
    };
    if (!job.runs) return finish('');

    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    job.inputs.forEach((input, unit) => {
        const bytes = unhex(input.bytes);
        const place = gl.getUniformLocation(program, input.name);
        if (input.resource === 'uniform_vector') {
            if (input.name.endsWith('corner')) gl.uniform2iv(place, new Int32Array(bytes.buffer, 0, 2));
            else if (input.name.endsWith('grid')) gl.uniform4uiv(place, new Uint32Array(bytes.buffer, 0, 4));
            else gl.uniform4fv(place, new Float32Array(bytes.buffer));
        } else if (input.resource === 'uniform_block') {
            const buffer = gl.createBuffer();
            made.push(() => gl.deleteBuffer(buffer));
            gl.bindBufferBase(gl.UNIFORM_BUFFER, unit, buffer);
            gl.bufferData(gl.UNIFORM_BUFFER, bytes, gl.STATIC_DRAW);
            gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, input.name), unit);
        } else {
            const [stored, format, type, Texels] = {
                r8uint: [gl.R8UI, gl.RED_INTEGER, gl.UNSIGNED_BYTE, Uint8Array],
                r16uint: [gl.R16UI, gl.RED_INTEGER, gl.UNSIGNED_SHORT, Uint16Array],
                r32uint: [gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT, Uint32Array],
                rg32uint: [gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT, Uint32Array],
            }[input.format];
            const texture = gl.createTexture();
            made.push(() => gl.deleteTexture(texture));
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(gl.TEXTURE_2D, texture);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
            gl.texImage2D(gl.TEXTURE_2D, 0, stored, input.width, input.height, 0, format, type,
                new Texels(bytes.buffer));
            gl.uniform1i(place, unit);
        }
    });
    const picture = gl.createTexture(), frame = gl.createFramebuffer();
    made.push(() => gl.deleteTexture(picture), () => gl.deleteFramebuffer(frame));
    gl.activeTexture(gl.TEXTURE15);
    const width = job.x + job.width, height = job.y + job.height;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    if (multiview) {
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, picture);
        gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA32UI, width, height, job.views);
        multiview.framebufferTextureMultiviewOVR(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, picture, 0, 0, job.views);
    } else {
        gl.bindTexture(gl.TEXTURE_2D, picture);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32UI, width, height);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, picture, 0);
    }
    gl.viewport(job.x, job.y, job.width, job.height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const words = new Uint32Array(4 * job.width * job.height * job.views);
    for (let view = 0; view < job.views; ++view) {
        if (multiview) gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, picture, 0, view);
        gl.readPixels(job.x, job.y, job.width, job.height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, words,
            view * words.length / job.views);
    }
    const expected = new Uint32Array(unhex(job.expected).buffer);
    return finish(words.every((word, i) => word === expected[i]) ? '' : 'is wrong');
}

// Leaves what there is to say in the page, the sum of it in the last line.
function runAll(jobs) {
    const lines = [];
    let bad = 0, runs = 0;
    for (const job of jobs) {
        let problem;
        try {
            problem = run(job);
        } catch (error) {
            problem = String(error);
        }
        if (job.runs) ++runs;
        if (problem && ++bad <= 3) lines.push(`${job.name}: ${problem}`, job.text);
    }
    lines.push(`${jobs.length - runs} texts compiled, ${runs} runs, ${bad} refused or wrong`);
    document.title = runs > 0 && bad === 0 ? 'passed' : 'failed';
    document.body.textContent = lines.join('\n');
}
