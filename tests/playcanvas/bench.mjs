// SPDX-License-Identifier: MIT
// node tests/playcanvas/bench.mjs: PlayCanvas' own clustered lights and lightbin's, with the same lights in turns in one
// page, all of them in view. The time of lists is that of all that PlayCanvas does in a frame for its clusters: find the
// lights, write them and the lists, upload both.
import {open} from '../browser.mjs';

const scenes = [[349, [10, 3, 10]], [1411, [32, 4, 32]], [3589, [32, 4, 32]]], frames = 300;
const {page, close, complaints} = await open(new URL('.', import.meta.url), 'Stage');
const rows = await page.evaluate(async ([scenes, frames]) => {
    const stages = {}, kinds = ['own', 'lists', 'all'], rows = [];
    for (const kind of kinds) {
        const {camera} = stages[kind] = await new Stage(kind).start({model: false});
        camera.setPosition(0, 55, 75);
        camera.lookAt(0, -5, 8);
    }

    // The order of the lights in a sum may change a byte by 1.
    const differs = (a, b, i) => i % 4 === 0 && [0, 1, 2].some(c => Math.abs(a[i + c] - b[i + c]) > 1);
    const wrong = (a, b) => a.filter((_, i) => differs(a, b, i)).length;

    const draw = stage => {
        const begin = performance.now();
        stage.render();
        const {gl} = stage.app.graphicsDevice;
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));  // waits for the picture
        return performance.now() - begin;
    };
    const by_turns = (count, body) => {
        for (let k = 0; k < count; ++k)
            for (const kind of k % 2 ? ['own', 'lists'] : ['lists', 'own']) body(kind, stages[kind].move(k / 10));
    };

    for (const [count, cells] of scenes) {
        const points = Math.round(0.7 * count), pictures = {}, frame = {own: [], lists: []};
        for (const kind of kinds) {
            const stage = stages[kind];
            stage.app.scene.lighting.cells = new pc.Vec3(...cells);
            stage.app.scene.lighting.maxLights = Math.max(count, 255);
            stage.resize(240, 150);
            stage.lights(points, count - points, {range: 8, extent: 38, strength: 100 / count, mixed: true});
            pictures[kind] = stage.draw();
        }
        const [own] = stages.own.drawn, [lists] = stages.lists.drawn, {ranges, ids} = stages.lists.clusters.grid;
        const lights = own.usedLights.length - 1;
        if (lists.usedLights.length - 1 !== lights) throw new Error('the two draw different lights');
        const row = {
            lights, cells: cells.join('x'),
            entries: [own.counts.reduce((sum, n) => sum + n), ids.length],
            longest: [Math.max(...own.counts), Math.max(...ranges.filter((_, i) => i % 2))],
            wrong: ['own', 'lists'].map(kind => wrong(pictures[kind], pictures.all)),
        };

        by_turns(12, (kind, stage) => frame[kind].push(draw(stage)));
        for (const kind in frame) stages[kind].resize(48, 30);
        by_turns(frames, (kind, stage) => draw(stage));  // until all that is called once in a frame is compiled
        for (const kind in frame) stages[kind].milliseconds.length = 0;
        by_turns(frames, (kind, stage) => draw(stage));
        row.lists = ['own', 'lists'].map(kind => median(stages[kind].milliseconds));
        row.least = ['own', 'lists'].map(kind => Math.min(...stages[kind].milliseconds));
        row.frame = ['own', 'lists'].map(kind => median(frame[kind]));
        rows.push(row);
    }
    return rows;
}, [scenes, frames]);
await close();
if (complaints.length > 0) throw new Error(complaints.join('\n'));

const pair = (numbers, digits = 0) => numbers.map(number => number.toFixed(digits)).join(' / ');
console.log(`PlayCanvas' own / lightbin; medians and least of ${frames} frames in turns\n`);
console.log('| lights in view | cells | lists, ms | ratio | least, ms | entries | longest list | wrong pixels '
    + '| whole frame, ms |');
console.log('|' + ' --- |'.repeat(9));
for (const {lights, cells, lists, least, frame, entries, longest, wrong} of rows) {
    const ratio = (lists[1] / lists[0]).toFixed(2);
    console.log(`| ${lights} | ${cells} | ${pair(lists, 2)} | ${ratio} | ${pair(least, 2)} | ${pair(entries)} `
        + `| ${pair(longest)} | ${pair(wrong)} | ${pair(frame)} |`);
}
