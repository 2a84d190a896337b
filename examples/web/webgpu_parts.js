// SPDX-License-Identifier: MIT
// What the WebGPU renderer is made of: buffers that grow, and programs with what is bound to them.

const {UNIFORM, STORAGE, VERTEX, COPY_SRC, COPY_DST, MAP_READ} = globalThis.GPUBufferUsage ?? {};
export const usages = {
    uniform: UNIFORM | COPY_DST,
    storage: STORAGE | COPY_SRC | COPY_DST,
    vertices: VERTEX | COPY_DST,
    results: MAP_READ | COPY_DST,
};

// A buffer as large as what it is given.
export class Store {
    buffer = null;

    constructor(device, usage) {
        this.device = device;
        this.usage = usage;
    }

    reserve(bytes) {
        if (this.buffer?.size >= bytes) return;
        const most = this.device.limits.maxStorageBufferBindingSize;
        if (bytes > most)
            throw new Error(`A buffer would take ${bytes} bytes, and shaders here read at most ${most}: ` +
                'use larger tiles or fewer lights.');
        this.buffer?.destroy();
        // Never empty, as a binding has to hold an element; and some more than is needed, as next time it may be more.
        const size = Math.min(Math.max(256, 1.25 * bytes), most);
        this.buffer = this.device.createBuffer({size: 4 * Math.ceil(size / 4), usage: this.usage});
    }

    write(words, at = 0) {
        this.reserve(at + words.byteLength);
        this.device.queue.writeBuffer(this.buffer, at, words);
    }

    // The first bytes of results, when the device has written them.
    async read(bytes) {
        await this.buffer.mapAsync(GPUMapMode.READ);
        const copy = this.buffer.getMappedRange().slice(0, bytes);
        this.buffer.unmap();
        return copy;
    }
}

const {VERTEX: vertex, FRAGMENT: fragment, COMPUTE: compute} = globalThis.GPUShaderStage ?? {};
const layouts = {  // of the resources that the bindings of lightbin's texts name
    'uniform-block': {visibility: vertex | fragment | compute, buffer: {type: 'uniform'}},
    'storage-buffer': {visibility: fragment | compute, buffer: {type: 'read-only-storage'}},
    'writable-buffer': {visibility: compute, buffer: {type: 'storage'}},
    'texture-2d': {visibility: compute, texture: {sampleType: 'unfilterable-float'}},
};

// A pipeline and its groups of bindings, {name, resource, slot} each.
export class Program {
    constructor(device, groups) {
        this.device = device;
        this.groups = groups.map(bindings => ({
            bindings,
            layout: device.createBindGroupLayout(
                {entries: bindings.map(({slot: {binding}, resource}) => ({binding, ...layouts[resource]}))}),
        }));
        this.layout = device.createPipelineLayout({bindGroupLayouts: this.groups.map(group => group.layout)});
    }

    static async for_surfaces(device, groups, descriptor) {
        const program = new Program(device, groups);
        program.pipeline = await device.createRenderPipelineAsync({...descriptor, layout: program.layout});
        return program;
    }

    static async for_compute(device, {text, bindings}) {
        const program = new Program(device, [bindings]), {layout} = program;
        const module = device.createShaderModule({code: text});
        program.pipeline = await device.createComputePipelineAsync({layout, compute: {module, entryPoint: 'main'}});
        return program;
    }

    // `resources`: by the bindings' names, Stores or views of textures.
    use(pass, resources) {
        pass.setPipeline(this.pipeline);
        const of = what => (what instanceof Store ? {buffer: what.buffer} : what);
        this.groups.forEach(({bindings, layout}, index) => pass.setBindGroup(index, this.device.createBindGroup({
            layout,
            entries: bindings.map(({name, slot: {binding}}) => ({binding, resource: of(resources[name])})),
        })));
    }
}
