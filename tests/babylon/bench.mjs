// SPDX-License-Identifier: MIT
// node bench.mjs: whole frames with Babylon's own clustered lights and with lightbin's, in turns in one page, and how
// many pixels of each differ by more than 1 of 255 from those of all lights in every fragment.
import {open} from '../browser.mjs';

const browser = await open(new URL('.', import.meta.url), 'Stage');
console.log('wrong pixels and ms are Babylon\'s own / lightbin\'s; a ratio has its quartiles');
for (const [name, options, points, spots, more] of [
    ['500 lights', {}, 350, 150],
    ['2,000 lights', {}, 1400, 600, {range: 2}],
    ['500, orthographic', {orthographic: true}, 350, 150],
    ['500, scene x 0.0001', {scale: 1e-4}, 350, 150],
    ['3,000 lights', {}, 2100, 900, {range: 1.5}],
    ['500, PBR', {pbr: 'standard'}, 350, 150],
]) {
    const {wrong, times} = await browser.page.evaluate(async given => {
        const stages = [], pictures = [], times = [[], []];
        for (const kind of ['own', 'lists', 'all']) {
            const stage = await new Stage(kind).start(given.options);
            pictures.push(await stage.lights(given.points, given.spots, given.more).draw());
            stages.push(stage);
        }
        const wrong = pictures.slice(0, 2).map(picture => picture.filter((_, i) => i % 4 === 0 && [0, 1, 2].some(
            c => Math.abs(picture[i + c] - pictures[2][i + c]) > 1)).length);
        const pixel = new Uint8Array(4);
        for (let frame = 0; frame < 35; ++frame)
            stages.slice(0, 2).forEach((stage, i) => {
                stage.move(frame / 10);
                const begin = performance.now(), {_gl: gl} = stage.engine;
                stage.render();
                gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);  // waits for the picture
                if (frame >= 5) times[i].push(performance.now() - begin);
            });
        for (const stage of stages) stage.destroy();
        return {wrong, times};
    }, {options, points, spots, more});
    const part = (list, of) => list.toSorted((a, b) => a - b)[Math.floor(of * list.length)];
    const ratios = times[1].map((ms, i) => ms / times[0][i]);
    console.log(`${name}: wrong pixels of 64,000: ${wrong.join(' / ')}; frame, ms: `
        + `${times.map(list => part(list, 0.5).toFixed(1)).join(' / ')}, ratio ${part(ratios, 0.5).toFixed(2)} `
        + `(${part(ratios, 0.25).toFixed(2)} to ${part(ratios, 0.75).toFixed(2)})`);
}
await browser.close();
