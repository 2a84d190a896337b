// SPDX-License-Identifier: MIT
// The lists that the page makes on the GPU, in WebGPU: they hold those that it makes on the CPU of the same lights, and
// hardly more; and where there was no room for them, no picture shows lists that were cut.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Browser} from './browser.mjs';

let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser.close());

// What runs in the page, with its own modules. Returns for each method and scene {of, on_cpu, on_gpu, at_most, lacking,
// unsorted, tries}: entries of both, and the most that the GPU's may have; the entries of the CPU that the GPU lacks;
// how many ids do not ascend; and how often the lists were made until they had room.
async function list_twice() {
    const [{load_lighting, wants_bounds, cull_options}, {CulledLists}, {Store, usages}] = await Promise.all(
        ['lighting', 'webgpu_lists', 'webgpu_parts'].map(name => import(`./${name}.js`)));
    const lighting = await load_lighting(), {scenes} = lighting;
    const device = await (await navigator.gpu.requestAdapter()).requestDevice();

    const read = async (store, Type, count) => {
        const encoder = device.createCommandEncoder(), results = new Store(device, usages.results);
        results.reserve(4 * count);
        encoder.copyBufferToBuffer(store.buffer, 0, results.buffer, 0, 4 * count);
        device.queue.submit([encoder.finish()]);
        return new Type(await results.read(4 * count));
    };
    const stored = words => {
        const store = new Store(device, usages.storage);
        store.write(words);
        return store;
    };
    const lists_of = ({ranges, ids}) => Array.from({length: ranges.length / 2}, (_, i) => {
        const list = Array.from(ids.subarray(ranges[2 * i], ranges[2 * i] + ranges[2 * i + 1]));
        return {unsorted: list.filter((id, i) => i > 0 && id <= list[i - 1]).length, lights: new Set(list)};
    });
    const entries_of = lists => lists.reduce((sum, {lights}) => sum + lights.size, 0);

    const on_gpu = async (settings, has_spots, for_glass, pairs) => {
        const {method, camera: {orthographic}} = settings, lists = new CulledLists(device);
        const kernels = await CulledLists.kernels(device, lighting,
            cull_options(method, orthographic, has_spots, for_glass));
        for (let tries = 1;; ++tries) {
            const frame = await lighting.gpu_frame(settings, lists.room, for_glass ? lists.room : null);
            const plan = frame.plans[Number(for_glass)];
            const shared = {lightbin_lights: stored(frame.shapes), lightbin_slices: stored(frame.slices)};
            lists.upload(plan, frame);
            if (pairs) lists.z_bounds.write(pairs);
            const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
            lists.encode(pass, kernels, plan, shared);
            pass.end();
            device.queue.submit([encoder.finish()]);
            const [entries] = await read(lists.scratch, Uint32Array, 1);
            if (!lists.has_room(entries)) continue;
            const ranges = await read(lists.tiles, Uint32Array, 2 * frame.cells);
            const ids = await read(lists.lists, Uint32Array, entries);
            return {ranges, ids, tries};
        }
    };

    const cpu_lists = (settings, bounds, for_glass) => {
        const frame = lighting.frame(settings, bounds);
        return lists_of(for_glass ? {ranges: frame.glass_ranges, ids: frame.glass_ids} : frame);
    };

    const found = [];
    const compare_with = async (of, settings, bounds, for_glass) => {
        const {has_spots} = scenes.scene, {tiles_x, tiles_y} = lighting.view(settings), tiles = tiles_x * tiles_y;
        const cpu = cpu_lists(settings, bounds, for_glass);
        // The planes around a spot's cone are compared with cells on the CPU, with the boxes around cells on the GPU.
        const boxes = has_spots && (settings.method === 'z_bounds' || settings.method === 'clusters');
        const sides = [bounds.min, for_glass ? bounds.glass_max : bounds.max];
        const pairs = wants_bounds(settings.method)
            ? Float32Array.from({length: 2 * tiles}, (_, i) => sides[i % 2][i >> 1]) : null;
        const {tries, ...made} = await on_gpu(settings, has_spots, for_glass, pairs), gpu = lists_of(made);
        found.push({
            of, tries, on_cpu: entries_of(cpu), on_gpu: entries_of(gpu),
            at_most: (boxes ? 1.3 : 1.005) * entries_of(cpu),
            lacking: cpu.reduce((sum, {lights}, i) => sum + [...lights].filter(id => !gpu[i].lights.has(id)).length, 0),
            unsorted: gpu.reduce((sum, {unsorted}) => sum + unsorted, 0),
        });
    };

    for (const scene of ['city', 'street']) {
        scenes.make(scene, 3000);
        const [camera] = scenes.scene.cameras;
        for (const orthographic of scene === 'city' ? [false, true] : [false])
            for (const method of ['none', 'clusters', 'z_bounds']) {
                const settings = {width: 640, height: 360, tile_size: 16, clip: 'webgpu', method, seconds: 2.5,
                    camera: orthographic ? {...camera, orthographic, height: 80} : camera};
                const {tiles_x, tiles_y} = lighting.view(settings), depths = {length: tiles_x * tiles_y};
                const bounds = {
                    min: Float32Array.from(depths, (_, i) => 5 + i % 40),
                    max: Float32Array.from(depths, (_, i) => (i % 9 === 0 ? -Infinity : 5 + i % 40 + i % 23)),
                    glass_max: Float32Array.from(depths, (_, i) => (i % 7 === 0 ? Infinity : 30 + i % 60)),
                };
                const of = `${scene}${orthographic ? ', orthographic' : ''}, ${method}`;
                await compare_with(of, settings, bounds, false);
                if (wants_bounds(method)) await compare_with(`${of}, glass`, settings, bounds, true);
            }
    }
    return found;
}

test('lists made on the GPU hold those made on the CPU', async t => {
    const page = await browser.open(t, 'lights=16&size=5&move=0');
    const found = await page.evaluate(list_twice);
    assert.equal(found.length, 3 * 4);
    for (const list of found) {
        const {of, on_cpu, on_gpu, at_most, lacking, unsorted, tries} = list;
        assert.deepEqual([lacking, unsorted], [0, 0], of);
        assert.ok(on_cpu > 500 && on_gpu <= at_most, JSON.stringify(list));
        assert.equal(tries, on_gpu > 1024 ? 2 : 1, of);
    }
    assert.deepEqual(page.complaints, []);
});

// The first picture of a renderer, whose lists have room for 1,024 entries, and the same by every light.
async function draw_first(method) {
    const [{load_lighting}, {WebGpu}, {compare}] = await Promise.all(
        ['lighting', 'webgpu', 'checks'].map(name => import(`./${name}.js`)));
    const lighting = await load_lighting(), renderer = await WebGpu.create(document.createElement('canvas'));
    const {triangles, glass, has_spots, cameras: [camera]} = lighting.scenes.make('street');
    renderer.set_scene({triangles, glass, has_spots});
    const settings = {camera, width: 320, height: 180, tile_size: 8, method, exposure: 1};
    const {different} = await compare(renderer, lighting, settings, document.createElement('canvas'));
    const {entries, in_view, rejected, longest} = await renderer.draw(lighting, {...settings, look: 'lit', drop: 3});
    return {different, entries, in_view, rejected, longest, glass: glass.length, lost: renderer.lost};
}

for (const method of ['clusters', 'z_bounds'])
    test(`${method}: the first picture shows no lists that were cut`, async t => {
        const page = await browser.open(t, 'lights=16&size=5&move=0');
        const {different, entries, in_view, rejected, longest, glass, lost} = await page.evaluate(draw_first, method);
        assert.equal(different, 0);
        assert.ok(entries > 1024 && glass > 0, `${entries} entries`);
        assert.ok(rejected === 0 && in_view > longest && longest > 1, `${in_view} in view, ${longest} in the longest`);
        assert.equal(lost, null);
        assert.deepEqual(page.complaints, []);
    });
