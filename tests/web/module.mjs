// SPDX-License-Identifier: MIT
// node tests/web/module.mjs FOLDER LISTS: the module that a browser gets, in FOLDER, makes the same lists as this
// machine's program, whose output LISTS is; what is wrong is a sentence; and all files together are small enough for a
// page.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [folder, lists] = process.argv.slice(2);
const {start} = await import(pathToFileURL(path.resolve(folder, 'lightbin.js')));
const lightbin = await start(fs.readFileSync(path.join(folder, 'lightbin.wasm')));
const settings = {width: 640, height: 360, tile_size: 16, clip: 'webgl', method: 'none'};

// FNV-1a, a word at a time.
function hash(...arrays) {
    let value = 2166136261;
    for (const array of arrays)
        for (const word of new Uint32Array(array.buffer, array.byteOffset, array.length))
            value = Math.imul(value ^ word, 16777619);
    return (value >>> 0).toString(16).padStart(8, '0');
}

function list_lines(scene, seconds) {
    const tiles = 40 * 23;
    const of_all = depth => new Float32Array(tiles).fill(depth);
    const bounds = {min: of_all(10), max: of_all(60), glass_max: of_all(100)};
    return ['none', 'interval', 'box', 'z_bins', 'clusters'].map(method => {
        const camera = lightbin.scene.cameras[0];
        const frame = lightbin.frame({...settings, camera, method, seconds}, bounds);
        const {ranges, ids, glass_ranges, glass_ids, slices, bins} = frame;
        return [scene, seconds, method, ids.length, hash(ranges, ids, glass_ranges, glass_ids, slices, bins)].join(' ');
    });
}

function same_lists() {
    const lines = [];
    for (const kind of ['city', 'street'])
        for (const seconds of [0, 2.5]) {
            lightbin.make(kind, 2000);
            lines.push(...list_lines(kind, seconds));
        }
    for (const name of ['nova.glb', 'darkness.glb']) {
        lightbin.open(fs.readFileSync(path.join(folder, name)), name);
        lines.push(...list_lines('file', 0));
    }
    assert.deepEqual(lines, fs.readFileSync(lists, 'utf8').trim().split('\n'));
    return `${lines.length} light grids are those of this machine's program, byte for byte`;
}

function no_scene() {
    const to_world = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    const asked = {...settings, camera: {to_world, orthographic: false, height: 1, near: 1, far: Infinity}};
    assert.equal(lightbin.scene.lights, 0);
    assert.throws(() => lightbin.frame(asked), /^Error: there is no scene yet$/);
    assert.equal(lightbin.view(asked).projection[11], -1);
    return 'there is no scene at first, which is a sentence too';
}

// A file of one node, with so many arrays in each other.
function nested_glb(depth) {
    const extras = '['.repeat(depth) + ']'.repeat(depth);
    const text = `{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"extras":${extras}}]}`;
    const json = text.padEnd(2 * depth + 96);
    const words = (...all) => Buffer.from(Uint32Array.from(all).buffer);
    const head = words(0x46546c67, 2, 20 + json.length + 12, json.length, 0x4e4f534a);
    return Buffer.concat([head, Buffer.from(json), words(4, 0x4e4942, 0)]);
}

function sentences() {
    const nova = fs.readFileSync(path.join(folder, 'nova.glb'));
    const camera = lightbin.make('city', 100).cameras[0];
    const three = new Float32Array(3);
    const asked = [
        [() => lightbin.open(nova.subarray(0, 1000), 'a.glb'), /^'a.glb': not a readable glTF binary: .+/],
        [() => lightbin.open(new Uint8Array(0), 'a.glb'), /^'a.glb': not a readable glTF binary: .+/],
        [() => lightbin.open(nested_glb(100), 'a.glb'), /^'a.glb': it has no point or spot lights/],
        ...Array(30).fill([() => lightbin.open(nested_glb(20000), 'a.glb'), /^this is too much for the browser: /]),
        [() => lightbin.make('city', 0), /^the city has 1 to 1000000 lights, not 0$/],
        [() => lightbin.frame({...settings, camera, tile_size: 0}), /^the tile size must be at least 1 pixel/],
        [() => lightbin.frame({...settings, camera, method: 'box'}, {min: three, max: three}), /Z bounds/],
        [() => lightbin.frame({...settings, camera, method: 'clusters', slices: 10000000}), /4294967295/],
        [() => lightbin.text('reduce', {language: 'essl_300', stage: 'compute'}), /no compute shaders/],
        [() => lightbin.text('snippet', {language: 'basic'}), /^there is no language 'basic'$/],
    ];
    for (const [ask, sentence] of asked) {
        assert.throws(ask, error => sentence.test(error.message) && !error.message.includes('\n'));
        assert.equal(lightbin.scene.lights, 100);
        assert.ok(lightbin.frame({...settings, camera}).entries > 0);
    }
    return `${new Set(asked).size} mistakes are sentences, and the scene lives on`;
}

function advice() {
    const seen = {...settings, camera: lightbin.make('city', 500).cameras[0]};
    const {tiles_x, tiles_y} = lightbin.view(seen), all = depth => new Float32Array(tiles_x * tiles_y).fill(depth);
    const bounds = {min: all(20), max: all(60)};
    bounds.glass_max = bounds.max;
    const without_depth = lightbin.advise(seen);
    const plans = lightbin.advise({...seen, z_bounds_milliseconds: 1000}, bounds);
    for (const some of [without_depth, plans]) {
        assert.ok(some.length > 5 && some[0].best && some.filter(plan => plan.best).length === 1);
        assert.ok(some.every((plan, i) => i === 0 || some[i - 1].milliseconds <= plan.milliseconds));
        assert.equal(some.find(plan => !plan.tiled).evaluations, 500 * settings.width * settings.height);
    }
    assert.ok(without_depth.every(plan => plan.depth_test === 'none' && plan.slicing === 'none'));

    // A plan has as many entries as the lists that the page makes of it, and a pre-pass costs what it took.
    for (const method of ['none', 'interval', 'box', 'z_bins', 'clusters']) {
        const sliced = method === 'z_bins' || method === 'clusters';
        const test = method === 'clusters' ? 'box' : sliced ? 'none' : method;
        const plan = plans.find(({footprint, depth_test, slicing, tile_size}) => footprint === 'rectangle'
            && depth_test === test && slicing === (sliced ? method : 'none') && tile_size === seen.tile_size);
        const lists = lightbin.frame({...seen, method}, sliced || method === 'none' ? null : bounds);
        assert.equal(plan.entries, lists.entries, method);
        assert.equal(plan.build_milliseconds > 1000, method === 'interval' || method === 'box', method);
    }
    return `advise() weighs ${plans.length} plans`;
}

function small() {
    const bytes = fs.readdirSync(folder).reduce((sum, name) => sum + fs.statSync(path.join(folder, name)).size, 0);
    assert.ok(bytes < 1.5e6, `the page has ${bytes} bytes`);
    return `the page has ${bytes} bytes in all`;
}

for (const test of [no_scene, same_lists, sentences, advice, small]) console.log(`module: ${test()}`);
