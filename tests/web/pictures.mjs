// SPDX-License-Identifier: MIT
// Every scene, depth method and renderer of the page draws what every light in every fragment draws, byte by byte, from
// the first picture on; and a list that lacks a light is found.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Browser, compare, mean_difference, picture, text_of, wait_for_text} from './browser.mjs';

const scenes = {city: /^300 lights/, street: /^598 lights/, nova: /^255 lights/, darkness: /^226 lights/};
const renderers = {webgl: 'WebGL 2', webgpu: 'WebGPU'};
const methods_of = renderer => ['none', 'clusters', 'z_bounds', ...renderer === 'webgl' ? ['z_bins'] : []];

let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser.close());

for (const [renderer, name] of Object.entries(renderers))
    test(`${name}: each scene with each depth method`, async t => {
        const page = await browser.open(t, `renderer=${renderer}&lights=300&size=20&tile=16`);
        for (const [scene, stats] of Object.entries(scenes)) {
            await page.locator('#scene').selectOption(scene);
            await wait_for_text(page, 'stats', stats);
            for (const method of methods_of(renderer)) {
                await page.locator('#method').selectOption(method);
                const said = await compare(page);
                assert.match(said, /^The same picture, byte by byte: 11,520 pixels/, `${scene}, ${method}`);
                assert.equal(await text_of(page, 'alert'), '');
            }
        }
        await wait_for_text(page, 'frame', new RegExp(name));
        assert.deepEqual(page.complaints, []);
    });

for (const [renderer, name] of Object.entries(renderers))
    test(`${name}: a light that the lists lack is found`, async t => {
        const page = await browser.open(t, `renderer=${renderer}&lights=16&view=2&size=20&tile=16&drop=3&move=0`);
        for (const method of methods_of(renderer)) {
            await page.locator('#method').selectOption(method);
            assert.match(await compare(page), /[0-9,]+ of 11,520 pixels differ, by up to/, method);
            assert.ok(await page.locator('#differences').isVisible());
            await page.locator('#close_verdict').click();
            assert.ok(!await page.locator('#differences').isVisible());
        }
        await wait_for_text(page, 'frame', new RegExp(`${name}.*light 3 left out`));
    });

// Both could lack the same light in both of their pictures; then the other one would show it.
test('WebGL 2 and WebGPU draw the same scenes', async t => {
    for (const [scene, stats] of Object.entries(scenes)) {
        const [webgl, webgpu] = await Promise.all(Object.entries(renderers).map(async ([renderer, name]) => {
            const page = await browser.open(t, `renderer=${renderer}&scene=${scene}&lights=300&size=50&tile=16&move=0`);
            await wait_for_text(page, 'stats', stats);
            await wait_for_text(page, 'frame', new RegExp(name));
            return picture(page);
        }));
        assert.ok(mean_difference(webgl) > 30, `${scene} is dark: ${mean_difference(webgl)}`);
        assert.ok(mean_difference(webgl, webgpu) < 1, `${scene}: ${mean_difference(webgl, webgpu)} apart`);
    }
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
