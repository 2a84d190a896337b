// SPDX-License-Identifier: MIT
// node --test tests/babylon/pictures.mjs: the adapter for Babylon.js in headless Chromium.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {test} from 'node:test';
import {complaints_of, page_of_tests, same} from '../browser.mjs';

const {page, complaints} = await page_of_tests(new URL('.', import.meta.url), 'Stage');
await page.evaluate(() => {
    /// Makes stages of some kinds, and ends them after body().
    window.among = async (kinds, options, body) => {
        const stages = [];
        for (const kind of kinds) stages.push(await new Stage(kind).start(options));
        const result = await body(...stages);
        for (const stage of stages) stage.destroy();
        return result;
    };
});

/// Where lights are added in another order, a byte may differ by 1.
function nearly(result, what) {
    same(result, what, 1);
    assert.ok(result.pixels < 20, `${what}: ${result.pixels} pixels differ`);
}

/// `own` says that Babylon's own container draws the same up to 1 of 255, by another program.
for (const [name, options, points, spots, more] of [
    ['500 lights', {}, 350, 150, {own: true}],
    ['300 lights, wide spots among them', {}, 150, 150, {wide: true}],
    ['3,000 lights', {width: 160, height: 100}, 2000, 1000, {range: 1.5}],
    ['an orthographic camera', {orthographic: true}, 350, 150],
    ['small units', {scale: 1e-4}, 350, 150],
    ['a right-handed scene', {rightHanded: true}, 350, 150, {own: true}],
    ['a reversed depth buffer', {reversedDepth: true}, 350, 150],
    ['a reversed depth buffer, orthographic', {reversedDepth: true, orthographic: true}, 70, 30],
    ['a large world', {largeWorld: 1e6}, 350, 150],
    ['no uniform buffers', {disableUniformBuffers: true}, 70, 30, {own: true}],
    ['PBR, standard falloff', {pbr: 'standard'}, 200, 100, {own: true}],
    ['PBR, falloff as in glTF', {pbr: 'gltf'}, 200, 100, {own: true}],
    ['PBR, physical falloff', {pbr: 'physical'}, 200, 100],
    ['WebGPU', {webgpu: true}, 350, 150, {own: true}],
    ['WebGPU, orthographic', {webgpu: true, orthographic: true}, 350, 150],
    ['WebGPU, small units', {webgpu: true, scale: 1e-4}, 350, 150],
    ['WebGPU, PBR', {webgpu: true, pbr: 'standard'}, 200, 100, {own: true}],
    ['WebGPU, PBR, physical falloff', {webgpu: true, pbr: 'physical'}, 200, 100],
])
    test(`${name}: as all lights in every fragment`, async () => {
        const {result, own, control, masks} = await page.evaluate(given => among(given.kinds, given.options,
            async (lists, all, own) => {
                const pictures = [];
                for (const stage of [lists, all, own].filter(stage => stage !== undefined))
                    pictures.push(await stage.lights(given.points, given.spots, given.more).draw());
                all.lamps.forEach((lamp, i) => lamp.setEnabled(i % 5 !== 0));
                const {lights, rejected, culled} = lists.container.masks;
                return {result: difference(pictures[0], pictures[1]), masks: {lights, rejected, culled},
                        own: pictures[2] && difference(pictures[0], pictures[2]),
                        control: difference(pictures[1], await all.changed().draw())};
            }), {options, points, spots, more, kinds: more?.own ? ['lists', 'all', 'own'] : ['lists', 'all']});
        nearly(result, name);
        if (own !== undefined) same(own, "Babylon's own", 1);
        assert.ok(control.pixels > 1000, `lights that are left out change ${control.pixels} pixels`);
        assert.equal(masks.lights, points + spots);
        assert.equal(masks.rejected, 0);
        assert.ok(masks.culled < (points + spots) / 2, `${masks.culled} lights are out of view`);
    });

for (const webgpu of [false, true])
    test(`${webgpu ? 'WebGPU' : 'WebGL'}: another size, two cameras in viewports, and one that draws to a texture`,
        async () => {
            const results = await page.evaluate(webgpu => among(['lists', 'all'], {webgpu}, async (...stages) => {
                const pictures = {size: [], cameras: [], target: []};
                for (const stage of stages) {
                    stage.lights(200, 100).resize(301, 173);
                    pictures.size.push(await stage.draw());
                    const other = stage.eye([-12, 6, -12], [0, -3, 0], {orthographic: true});
                    pictures.target.push(await stage.drawTarget(other, 128, 96));
                    stage.camera.viewport = new Viewport(0, 0, 0.5, 1);
                    other.viewport = new Viewport(0.5, 0.2, 0.4, 0.6);
                    stage.scene.activeCameras = [stage.camera, other];
                    pictures.cameras.push(await stage.draw());
                }
                return Object.fromEntries(Object.entries(pictures).map(([name, all]) => [name, difference(...all)]));
            }), webgpu);
            for (const [name, result] of Object.entries(results)) nearly(result, name);
        });

test('lights that change, come and go', async () => {
    const results = await page.evaluate(() => among(['lists', 'all'], {}, async (lists, all) => {
        const steps = {
            few: stage => stage.lights(30, 20, {range: 6}),
            moved: stage => stage.move(1),
            more: stage => stage.lights(300, 200),
            removed: stage => stage.lamps.splice(0, 100).forEach(lamp => stage.remove(lamp)),
            changed: stage => stage.lamps.forEach(lamp => {
                lamp.range *= 1.2;
                lamp.intensity *= 0.7;
            }),
            disabled: stage => stage.lamps.forEach((lamp, i) => lamp.setEnabled(i % 2 === 0)),
        };
        const results = {};
        let last;
        for (const [name, step] of Object.entries(steps)) {
            const pictures = [];
            for (const stage of [lists, all]) {
                step(stage);
                pictures.push(await stage.changed().draw());
            }
            results[name] = {...difference(...pictures), changed: last ? difference(last, pictures[0]).pixels : 1000};
            last = pictures[0];
        }
        lists.lamps[2].dispose();
        const lights = (await lists.draw(), lists.container.masks.lights);
        for (const lamp of lists.lamps) lists.container.removeLight(lamp);
        for (const lamp of lists.lamps) lamp.dispose();
        const dark = await lists.draw(), sum = dark.reduce((sum, byte, i) => sum + (i % 4 < 3 ? byte : 0), 0);
        return {results, lights, left: lists.lamps.length, dark: sum / (0.75 * dark.length)};
    }));
    for (const [name, {changed, ...result}] of Object.entries(results.results)) {
        nearly(result, name);
        assert.ok(changed > 500, `${name} changes ${changed} pixels`);
    }
    assert.equal(results.lights, results.left / 2 - 1);
    assert.ok(results.dark < 10, `without lights a picture has ${results.dark}`);
});

test('the ShaderMaterial of docs/babylon.md: as all lights in every fragment', async () => {
    const guide = fs.readFileSync(new URL('../../docs/babylon.md', import.meta.url), 'utf8');
    const [program] = [...guide.matchAll(/^```js\n(.*?)^```$/gms)].map(([, block]) => block)
        .filter(block => /new ShaderMaterial/.test(block));
    const all = program.replace(/lightbin_for_each_light\(light, .*\{\n.*lamp = .*light.id/,
        'for (int id = 0; id < 150; ++id) { vec4 lamp = texelFetch(lamps, ivec2(id');
    assert.notEqual(all, program);
    const {result, control} = await page.evaluate(async programs => {
        const AsyncFunction = (async () => {}).constructor, pictures = [];
        for (const [program, count] of [...programs.map(program => [program, 150]), [programs[0], 120]])
            pictures.push(await among(['lists'], {}, async stage => {
                const {scene, engine, meshes} = stage;
                stage.lights(count, 0);
                const numbers = stage.lamps.flatMap(({position: {x, y, z}, range}) => [x, y, z, range]);
                const lamps = Float32Array.from(numbers);
                const given = {...names, scene, engine, lamps, count};
                const run = new AsyncFunction(...Object.keys(given), `${program}\nreturn {material, made: [binner, view]};`);
                const {material, made} = await run(...Object.values(given));
                for (const mesh of meshes) mesh.material = material;
                stage.render();  // which makes the textures that readiness asks for
                const picture = await stage.draw();
                for (const each of made) each.dispose();
                return picture;
            }));
        return {result: difference(...pictures), control: difference(pictures[0], pictures[2])};
    }, [program, all]);
    nearly(result, 'a ShaderMaterial');
    assert.ok(control.pixels > 1000, `lights that are left out change ${control.pixels} pixels`);
});

test('what can make no masks is drawn with all lights, and says so once', async () => {
    const results = await page.evaluate(() => among(['lists'], {}, async lists => {
        const before = await lists.lights(30, 20, {range: 6}).draw(), {scene} = lists;
        const matrix = scene.getProjectionMatrix;
        // As much as the masks see of it.
        scene.getProjectionMatrix = () => ({m: new Float32Array(16).fill(NaN)});
        lists.render();
        const bad = difference(before, await lists.draw());
        scene.getProjectionMatrix = matrix;
        const after = difference(before, await lists.draw());
        const lamp = lists.lamps[3], {x} = lamp.position;
        lamp.position.x = NaN;
        await lists.draw();
        const {rejected} = lists.container.masks;
        lamp.position.x = x;
        return {bad, after, rejected, again: difference(before, await lists.draw())};
    }));
    same(results.bad, 'a bad matrix');
    same(results.after, 'a good one again');
    same(results.again, 'a good light again');
    assert.equal(results.rejected, 1);
    const warnings = complaints.splice(0);
    assert.equal(warnings.length, 1, `${warnings}`);
    assert.match(warnings[0], /all lights where it can't make masks: .*NaN/);
});

test('what is refused, and dispose()', async () => {
    const {second, before, after, allocations} = await page.evaluate(async () => {
        const lists = await new Stage('lists').start();
        await lists.lights(30, 20).draw();
        let second = '';
        try {
            new ClusteredLights(lightbin, '', [], lists.scene);
        } catch (error) {
            second = error.message;
        }
        const before = lists.scene.textures.length;
        lists.container.dispose();
        await lists.draw();
        const after = lists.scene.textures.length;
        lists.destroy();
        return {second, before, after, allocations: lightbin.allocations};
    });
    assert.match(second, /has a ClusteredLightContainer/);
    assert.ok(before >= 3, `${before} textures`);
    assert.equal(after, 0);
    assert.equal(allocations, 0);
});

test('a version of Babylon.js with other shaders is refused', async () => {
    const other = await page.context().browser().newPage(), others = complaints_of(other);
    await other.goto(page.url());
    await other.waitForFunction(() => window.Stage !== undefined);
    const messages = await other.evaluate(async () => {
        const store = ShaderStore.IncludesShadersStoreWGSL, text = store.clusteredLightingCompute, messages = [];
        store.clusteredLightingCompute = text.replaceAll('batchOffset', 'batch_offset');
        // The second time shows that the first one changed nothing.
        for (const replaced of [true, true, false]) {
            if (!replaced) store.clusteredLightingCompute = text;
            const refused = new Stage('lists').start({width: 16, height: 16}).then(() => '', error => error.message);
            messages.push(await refused);
        }
        if (ShaderStore.IncludesShadersStore.lightUboDeclaration.split('#define LIGHTBIN_MASKS').length !== 2)
            messages.push('shaders were changed before');
        return messages;
    });
    assert.match(messages[0], /^this version of Babylon.js has other shaders: clusteredLightingCompute has no /);
    assert.deepEqual(messages, [messages[0], messages[0], '']);
    assert.deepEqual(others, []);
    await other.close();
});
