// SPDX-License-Identifier: MIT
// node tests/web/lists.mjs FOLDER: the page in FOLDER says what is wrong in sentences, keeps no memory, and is small.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [folder] = process.argv.slice(2);
const of_page = name => import(pathToFileURL(path.resolve(folder, name)));
const bytes = name => fs.readFileSync(path.join(folder, name));
const [{load}, {Lighting}, {start}] = await Promise.all(['lightbin/lightbin.js', 'lighting.js', 'scenes.js'].map(of_page));
const [wasm, shaders] = ['lightbin_simd', 'shaders'].map(name => bytes(`lightbin/${name}.wasm`));
const lightbin = await load({wasm, shaders});
const scenes = await start(bytes('scenes.wasm')), lighting = new Lighting(lightbin, scenes);
const settings = {width: 640, height: 360, tile_size: 16, clip: 'webgl', method: 'none'};

function no_scene() {
    const to_world = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    const asked = {...settings, camera: {to_world, orthographic: false, height: 1, near: 1, far: Infinity}};
    assert.equal(scenes.scene.lights, 0);
    assert.throws(() => lighting.frame(asked), /^Error: there is no scene yet$/);
    assert.equal(lighting.view(asked).projection[11], -1);
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
    const nova = bytes('nova.glb'), camera = scenes.make('city', 100).cameras[0], three = new Float32Array(3);
    const asked = [
        [() => scenes.open(nova.subarray(0, 1000), 'a.glb'), /^'a.glb': not a readable glTF binary: .+/],
        [() => scenes.open(new Uint8Array(0), 'a.glb'), /^'a.glb': not a readable glTF binary: .+/],
        [() => scenes.open(nested_glb(100), 'a.glb'), /^'a.glb': it has no point or spot lights/],
        ...Array(30).fill([() => scenes.open(nested_glb(20000), 'a.glb'), /^this is too much for the browser: /]),
        [() => scenes.make('city', 0), /^the city has 1 to 1000000 lights, not 0$/],
        [() => lighting.frame({...settings, camera, tile_size: -1}), /^the tile size must be at least 1 pixel/],
        [() => lighting.frame({...settings, camera, method: 'z_bounds'}, {min: three, max: three}), /Z bounds/],
        [() => lighting.frame({...settings, camera, method: 'clusters', slices: 10000000}), /4294967295|memory/],
        [() => lighting.frame({...settings, camera, method: 'basic'}), /^there is no method 'basic'$/],
    ];
    for (const [ask, sentence] of asked) {
        assert.throws(ask, error => sentence.test(error.message) && !error.message.includes('\n'), `${ask}`);
        assert.equal(scenes.scene.lights, 100);
        assert.ok(lighting.frame({...settings, camera}).entries > 0);
    }
    return `${new Set(asked).size} mistakes are sentences, and the scene lives on`;
}

function small() {
    const sizes = fs.readdirSync(folder, {recursive: true}).map(name => fs.statSync(path.join(folder, name)))
        .filter(file => file.isFile()).map(file => file.size), sum = sizes.reduce((a, b) => a + b);
    assert.ok(sum < 1.8e6, `the page has ${sum} bytes`);
    return `the page has ${sum} bytes in all`;
}

// As a page that draws for hours: nothing is left over but what is kept from frame to frame.
function frees() {
    const seen = {...settings, camera: scenes.make('city', 500).cameras[0], method: 'clusters'};
    lighting.frame(seen);
    const live = lightbin.allocations;
    for (let i = 0; i < 100; ++i) lighting.frame({...seen, seconds: i});
    assert.equal(lightbin.allocations, live);
    return `${live} blocks of memory are kept`;
}

for (const test of [no_scene, sentences, small, frees])
    console.log(`lists: ${await test()}`);
