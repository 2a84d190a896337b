// SPDX-License-Identifier: MIT
// Runs the jobs of write_jobs in WebGPU, FOLDER/write_wgsl_jobs being that: `run_jobs.mjs FOLDER [MODULE] FIRST COUNT`.
// Deno has its own WebGPU; Node takes it from MODULE, that of the npm package webgpu. The text being tried is kept in
// FOLDER, as a compiler may end the process.
import { Buffer } from 'node:buffer';
import { spawn } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import process from 'node:process';

async function find_gpu(module) {
    if (!module) return navigator.gpu;
    const { create, globals } = await import(module);
    Object.assign(globalThis, globals);
    return create([]);
}

const full_triangle = `@vertex fn main(@builtin(vertex_index) i : u32) -> @builtin(position) vec4f {
    return vec4f(4.0 * f32(i & 1u) - 1.0, 2.0 * f32(i & 2u) - 1.0, 0.0, 1.0);
}`;

// Draws each sample of a texture of floats from a buffer of them.
const fill_samples = `
@group(0) @binding(0) var<storage, read> samples : array<f32>;
@group(0) @binding(1) var<uniform> size : vec4u;
@fragment fn main(@builtin(position) at : vec4f, @builtin(sample_index) sample_index : u32) -> @location(0) vec4f {
    return vec4f(samples[(u32(at.y) * size.x + u32(at.x)) * size.y + sample_index], 0.0, 0.0, 0.0);
}`;

class Device {
    // Dawn ends with its `gpu`: it is kept from the garbage collector.
    constructor(gpu, device) {
        this.gpu = gpu;
        this.device = device;
        this.known = new Map();
        this.vertex = { module: device.createShaderModule({ code: full_triangle }), entryPoint: 'main' };
    }

    buffer(bytes, usage) {
        const buffer = this.device.createBuffer({ size: bytes.length, usage, mappedAtCreation: true });
        new Uint8Array(buffer.getMappedRange()).set(bytes);
        buffer.unmap();
        return buffer;
    }

    // Throws what the compiler says: a warning is as bad as an error.
    async module(code) {
        const module = this.device.createShaderModule({ code });
        const { messages } = await module.getCompilationInfo();
        const said = messages.map(m => `${m.lineNum}:${m.linePos}: ${m.type}: ${m.message}`);
        if (said.length) throw new Error(said.join('\n'));
        return { module, entryPoint: 'main' };
    }

    // As the bindings tell, not as the text has it: the two must agree.
    layouts(job) {
        const visibility = job.stage === 'compute' ? GPUShaderStage.COMPUTE : GPUShaderStage.FRAGMENT;
        const types = { uniform_block: 'uniform', storage_buffer: 'read-only-storage', writable_buffer: 'storage' };
        const groups = Math.max(0, ...job.inputs.map(input => input.set + 1));
        return Array.from({ length: groups }, (_, group) => this.device.createBindGroupLayout({
            entries: job.inputs.filter(input => input.set === group).map(input => ({
                binding: input.binding,
                visibility,
                ...(input.resource === 'texture_2d'
                    ? { texture: {
                        sampleType: input.format.endsWith('uint') ? 'uint' : 'unfilterable-float',
                        multisampled: input.samples > 1,
                    } }
                    : { buffer: { type: types[input.resource], minBindingSize: input.size } }),
            })),
        }));
    }

    // Jobs that ask for results come with the same texts again and again, and with the same bindings then.
    async pipeline(job, layouts) {
        if (!job.asks) return this.new_pipeline(job, layouts);
        if (!this.known.has(job.text)) this.known.set(job.text, await this.new_pipeline(job, layouts));
        return this.known.get(job.text);
    }

    async new_pipeline(job, layouts) {
        const stage = await this.module(job.text);
        const layout = this.device.createPipelineLayout({ bindGroupLayouts: layouts });
        if (job.stage === 'compute') return this.device.createComputePipelineAsync({ layout, compute: stage });
        return this.draw_pipeline(layout, stage, target_of(job));
    }

    draw_pipeline(layout, stage, format, count = 1) {
        return this.device.createRenderPipelineAsync({
            layout,
            vertex: this.vertex,
            fragment: { ...stage, targets: [{ format }] },
            multisample: { count },
        });
    }

    async resource(input) {
        const bytes = Buffer.from(input.bytes, 'hex');
        if (input.resource !== 'texture_2d') {
            const usage = input.resource === 'uniform_block' ? GPUBufferUsage.UNIFORM
                : GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC;
            return this.buffer(bytes, usage);
        }
        const texture = this.device.createTexture({
            size: [input.width, input.height],
            format: input.format,
            sampleCount: input.samples,
            usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST | GPUTextureUsage.RENDER_ATTACHMENT,
        });
        if (input.samples > 1)
            await this.fill_samples(texture, bytes);
        else
            this.device.queue.writeTexture({ texture }, bytes, { bytesPerRow: bytes.length / input.height },
                [input.width, input.height]);
        return texture;
    }

    async fill_samples(texture, bytes) {
        this.fill ??= await this.draw_pipeline('auto', await this.module(fill_samples), texture.format,
            texture.sampleCount);
        const size = Buffer.from(new Uint32Array([texture.width, texture.sampleCount, 0, 0]).buffer);
        const buffers = [this.buffer(bytes, GPUBufferUsage.STORAGE), this.buffer(size, GPUBufferUsage.UNIFORM)];
        const group = this.device.createBindGroup({
            layout: this.fill.getBindGroupLayout(0),
            entries: buffers.map((buffer, binding) => ({ binding, resource: { buffer } })),
        });
        const encoder = this.device.createCommandEncoder();
        this.draw(encoder, this.fill, [group], texture);
        this.device.queue.submit([encoder.finish()]);
    }

    draw(encoder, pipeline, groups, picture, viewport) {
        const attachment = { view: picture.createView(), loadOp: 'clear', storeOp: 'store', clearValue: [0, 0, 0, 0] };
        const pass = encoder.beginRenderPass({ colorAttachments: [attachment] });
        pass.setPipeline(pipeline);
        groups.forEach((group, i) => pass.setBindGroup(i, group));
        if (viewport) pass.setViewport(...viewport, 0, 1);
        pass.draw(3);
        pass.end();
    }

    // Draws the job's pixels, and returns a buffer of them and the bytes of a row there.
    draw_job(job, encoder, pipeline, groups) {
        const picture = this.device.createTexture({
            size: [job.x + job.width, job.y + job.height],
            format: target_of(job),
            usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC,
        });
        this.draw(encoder, pipeline, groups, picture, [job.x, job.y, job.width, job.height]);
        const row = (job.within ? 8 : 16) * job.width, bytesPerRow = Math.ceil(row / 256) * 256;
        const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
        const buffer = this.device.createBuffer({ size: bytesPerRow * job.height, usage });
        encoder.copyTextureToBuffer({ texture: picture, origin: [job.x, job.y] }, { buffer, bytesPerRow },
            [job.width, job.height]);
        return { buffer, row, bytesPerRow, made: [picture, buffer] };
    }

    dispatch_job(job, encoder, pipeline, groups, result) {
        const pass = encoder.beginComputePass();
        pass.setPipeline(pipeline);
        groups.forEach((group, i) => pass.setBindGroup(i, group));
        pass.dispatchWorkgroups(...job.groups);
        pass.end();
        const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
        const buffer = this.device.createBuffer({ size: result.size, usage });
        encoder.copyBufferToBuffer(result, 0, buffer, 0, result.size);
        return { buffer, row: result.size, bytesPerRow: result.size, made: [buffer] };
    }

    // Returns the bytes that the job wrote.
    async run(job, pipeline, layouts) {
        const resources = [];
        for (const input of job.inputs) resources.push(await this.resource(input));
        const groups = layouts.map((layout, group) => this.device.createBindGroup({
            layout,
            entries: job.inputs.flatMap((input, i) => input.set !== group ? [] : [{
                binding: input.binding,
                resource: input.resource === 'texture_2d' ? resources[i].createView() : { buffer: resources[i] },
            }]),
        }));
        const encoder = this.device.createCommandEncoder();
        const written = job.stage === 'compute'
            ? this.dispatch_job(job, encoder, pipeline, groups, resources[job.result])
            : this.draw_job(job, encoder, pipeline, groups);
        this.device.queue.submit([encoder.finish()]);
        await written.buffer.mapAsync(GPUMapMode.READ);
        const mapped = Buffer.from(written.buffer.getMappedRange());
        const rows = [];
        for (let at = 0; at < mapped.length; at += written.bytesPerRow)
            rows.push(mapped.subarray(at, at + written.row));
        const bytes = Buffer.concat(rows);
        [...resources, ...written.made].forEach(made => made.destroy());
        return bytes;
    }

    // Returns what is wrong, or ''. `answer` takes what was written by a job that asks for it.
    async try(job, answer) {
        this.device.pushErrorScope('validation');
        let problem = '';
        try {
            const layouts = this.layouts(job);
            const pipeline = await this.pipeline(job, layouts);
            const bytes = job.runs && await this.run(job, pipeline, layouts);
            if (job.asks) answer(bytes);
            else if (job.runs && !accepts(job, bytes)) problem = 'is wrong';
        } catch (error) {
            problem = 'refused: ' + error.message;
        }
        const error = await this.device.popErrorScope();
        return error && !problem.startsWith('refused') ? 'refused: ' + error.message : problem;
    }
}

function target_of(job) {
    return job.within ? 'rg32float' : 'rgba32uint';
}

function accepts(job, bytes) {
    const wanted = Buffer.from(job.within ?? job.expected, 'hex');
    if (!job.within) return bytes.equals(wanted);
    const value = i => bytes.readFloatLE(4 * i), low = i => wanted.readFloatLE(8 * i),
        high = i => wanted.readFloatLE(8 * i + 4);
    const all = Array.from({ length: bytes.length / 4 }, (_, i) => value(i) >= low(i) && value(i) <= high(i));
    return 2 * bytes.length === wanted.length && all.every(Boolean);
}

// Reads no further than lines are taken: Node's readline would keep gigabytes of jobs that wait.
async function* lines_of(stream) {
    let rest = '';
    for await (const chunk of stream.setEncoding('utf8')) {
        const lines = chunk.split('\n');
        lines[0] = rest + lines[0];
        rest = lines.pop();
        yield* lines;
    }
}

const places = process.argv.slice(2), share = places.splice(-2), [folder, module] = places;
const gpu = await find_gpu(module);
const adapter = await gpu.requestAdapter();
if (!adapter) {
    console.log('there is no WebGPU adapter');
    process.exit(1);
}
const waves = adapter.features.has('subgroups');
const device = new Device(gpu, await adapter.requestDevice({ requiredFeatures: waves ? ['subgroups'] : [] }));
const writer = spawn(`${folder}/write_wgsl_jobs`, share, { stdio: ['pipe', 'pipe', 'inherit'] });
const written = new Promise(resolve => writer.on('close', (code, signal) => resolve(code ?? signal)));
let texts = 0, runs = 0, bad = 0, left_out = 0;
for await (const line of lines_of(writer.stdout)) {
    if (!line.startsWith('{')) {
        console.log(line);
        continue;
    }
    const job = JSON.parse(line);
    if (!waves && job.text.includes('enable subgroups')) {
        ++left_out;
        continue;
    }
    writeFileSync(`${folder}/${module ? 'dawn' : 'naga'}.${share[0]}.wgsl`, `// ${job.name}\n${job.text}`);
    let answer = '';
    const problem = await device.try(job, bytes => answer = bytes.toString('hex'));
    if (job.asks) writer.stdin.write(answer + '\n');
    if (job.runs) ++runs;
    else ++texts;
    if (problem && ++bad <= 3) console.log(`${job.name}: ${problem}\n${job.text}`);
}
const failed = await written;
if (failed) console.log(`write_wgsl_jobs ended with ${failed}`);
console.log(`${texts} texts compiled, ${runs} runs, ${bad} refused or wrong` +
    (left_out ? `, ${left_out} left out as there are no subgroups` : '') + `, on ${adapter.info.description}`);
process.exit(texts === 0 || runs === 0 || bad > 0 || failed ? 1 : 0);
