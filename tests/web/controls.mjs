// SPDX-License-Identifier: MIT
// Each control of the page does what it says: by mouse, by finger and by key.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Browser, compare, mean_difference, picture, set_slider, text_of, wait_for_text} from './browser.mjs';

const small = 'lights=100&size=20&tile=16';
let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser.close());

const place = page => page.evaluate(() => new URLSearchParams(location.hash.slice(1)).get('at') ?? '');

// Waits until the address tells another place, and returns its numbers: x, y, z, yaw, pitch.
async function moved_from(page, before) {
    await page.waitForFunction(before => {
        const at = new URLSearchParams(location.hash.slice(1)).get('at') ?? '';
        return at !== '' && at !== before;
    }, before);
    return (await place(page)).split(',').map(Number);
}

test('the slider of lights changes the lights and their lists', async t => {
    const page = await browser.open(t, small);
    const [few] = (await text_of(page, 'stats')).match(/\d+ a cluster/);
    await set_slider(page, 'lights', 500);
    const stats = await wait_for_text(page, 'stats', /^890 lights/);
    assert.ok(parseInt(stats.match(/(\d+) a cluster/)[1]) > parseInt(few), stats);
    await set_slider(page, 'lights', 1000);
    await wait_for_text(page, 'stats', /^50,000 lights/);
    assert.match(page.url(), /lights=50000/);
    assert.deepEqual(page.complaints, []);
});

test('tile size and depth method change the grid', async t => {
    const page = await browser.open(t, small);
    await wait_for_text(page, 'frame', /144 × 80 pixels, 9 × 5 tiles/);
    await set_slider(page, 'tile', 8);
    await wait_for_text(page, 'frame', / 18 × 10 tiles/);
    assert.equal(await text_of(page, 'tile_out'), '8 pixels');
    for (const [method, word] of Object.entries({z_bins: 'tile', clusters: 'cluster', box: 'tile'})) {
        await page.locator('#method').selectOption(method);
        await wait_for_text(page, 'stats', new RegExp(`a ${word} at most`));
    }
    // Only bounds want a depth pre-pass, and the plot says what it takes.
    await page.waitForFunction(() => parseFloat(document.querySelector('#costs b').textContent) > 0);
});

test('resolution, brightness and look change the picture', async t => {
    const page = await browser.open(t, small + '&move=0');
    await page.locator('#size').selectOption('50');
    await wait_for_text(page, 'frame', /360 × 200 pixels/);
    const as_metered = await picture(page);
    await set_slider(page, 'stops', 3);
    assert.equal(await text_of(page, 'stops_out'), '+3 stops');
    await page.waitForFunction(() => location.hash.includes('stops=3'));
    assert.ok(mean_difference(await picture(page)) > 1.3 * mean_difference(as_metered));
    await page.locator('#look').selectOption('heat');
    await page.locator('#heat_legend').waitFor();
    assert.ok(mean_difference(await picture(page), as_metered) > 10);
    assert.match(await text_of(page, 'heat_legend'), /^0 lights a pixel [1-9]/);
    await page.locator('#look').selectOption('check');
    await page.locator('#check_legend').waitFor();
    await page.locator('#size').selectOption('auto');
    await page.waitForFunction(() => !location.hash.includes('size'));
});

test('a picture where nothing moves gets sharper, until something does', async t => {
    const page = await browser.open(t, 'lights=100&tile=32&move=0');
    const width = text => parseInt(text.match(/(\d+) ×/)[1]);
    const sharp = width(await wait_for_text(page, 'frame', /^WebGL 2, (?!144 )/));
    assert.ok(sharp > 144);
    await page.keyboard.down('w');
    while (width(await text_of(page, 'frame')) >= sharp) await page.waitForTimeout(20);
    await page.keyboard.up('w');
    assert.deepEqual(page.complaints, []);
});

test('the list check is magenta where a list lacks a light, and nowhere else', async t => {
    const magenta = async page => {
        const seen = await picture(page);
        let found = 0;
        for (let i = 0; i < seen.length; i += 3) found += seen[i] > 200 && seen[i + 1] < 50 && seen[i + 2] > 200;
        await page.close();
        return found;
    };
    for (const lists of ['', '&renderer=webgpu']) {
        const few = 'lights=16&view=2&size=20&tile=16&look=check&move=0' + lists;
        assert.equal(await magenta(await browser.open(t, few)), 0, few);
        assert.ok(await magenta(await browser.open(t, few + '&drop=3')) > 10, few);
    }
});

test('lights move until they are stopped', async t => {
    const page = await browser.open(t, small);
    const earlier = await picture(page);
    await page.waitForTimeout(300);
    assert.notDeepEqual(await picture(page), earlier);
    await page.locator('#move').uncheck();
    await page.waitForFunction(() => location.hash.includes('move=0'));
    const stopped = await picture(page);
    await page.waitForTimeout(300);
    assert.deepEqual(await picture(page), stopped);
    await page.locator('#stage').focus();
    await page.keyboard.press('Space');
    assert.ok(await page.locator('#move').isChecked());
});

test('who wants less motion gets lights that stand', async t => {
    const page = await browser.open(t, small, {reducedMotion: 'reduce'});
    assert.ok(!await page.locator('#move').isChecked());
    const stopped = await picture(page);
    await page.waitForTimeout(300);
    assert.deepEqual(await picture(page), stopped);
});

test('the mouse turns, moves sideways and zooms', async t => {
    const page = await browser.open(t, small + '&move=0');
    const drag = async button => {
        await page.mouse.move(200, 200);
        await page.mouse.down({button});
        await page.mouse.move(260, 230, {steps: 4});
        await page.mouse.up({button});
    };
    await drag('left');
    const turned = await moved_from(page, '');
    assert.ok(Math.hypot(turned[0] + 40, turned[2] - 60) > 5, `it orbits, so it moves: ${turned}`);
    await drag('right');
    const panned = await moved_from(page, turned.join());
    assert.deepEqual(panned.slice(3, 5), turned.slice(3, 5));
    await page.mouse.wheel(0, -400);
    const zoomed = await moved_from(page, panned.join());
    assert.ok(zoomed[1] < panned[1], 'looking down, nearer is lower');
    assert.ok(zoomed[5] < panned[5]);
});

test('one finger turns, two zoom and move sideways', async t => {
    const page = await browser.open(t, small + '&move=0', {width: 390, height: 844, touch: true});
    const fingers = await page.context().newCDPSession(page);
    const touch = (type, ...points) =>
        fingers.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([x, y], id) => ({x, y, id}))});
    await touch('touchStart', [200, 300]);
    await touch('touchMove', [240, 320]);
    await touch('touchEnd');
    const turned = await moved_from(page, '');
    await touch('touchStart', [180, 300], [220, 300]);
    await touch('touchMove', [150, 300], [250, 300]);
    await touch('touchEnd');
    const zoomed = await moved_from(page, turned.join());
    assert.ok(zoomed[5] < 0.7 * turned[5], `${turned} ${zoomed}`);
    await touch('touchStart', [180, 300], [220, 300]);
    await touch('touchMove', [180, 360], [220, 360]);
    await touch('touchEnd');
    const panned = await moved_from(page, zoomed.join());
    assert.deepEqual(panned.slice(3, 6), zoomed.slice(3, 6));
});

test('keys fly, choose cameras and reach the main controls', async t => {
    const page = await browser.open(t, small + '&move=0');
    await page.keyboard.down('w');
    const flown = await moved_from(page, '');
    await page.waitForTimeout(200);
    await page.keyboard.up('w');
    assert.ok(Math.hypot(flown[0] + 40, flown[1] - 30, flown[2] - 60) > 0.01);
    await page.keyboard.press('2');
    await page.waitForFunction(() => location.hash.includes('view=1') && !location.hash.includes('at='));
    await page.keyboard.press('h');
    assert.equal(await page.locator('#look').inputValue(), 'heat');
    await page.keyboard.press('m');
    assert.equal(await page.locator('#method').inputValue(), 'z_bounds');
    await page.keyboard.press(']');
    assert.equal(await text_of(page, 'tile_out'), '24 pixels');
    await page.keyboard.press('+');
    await wait_for_text(page, 'lights_out', /^1[1-9]\d$/);
    await page.keyboard.press('p');
    assert.ok(!await page.locator('#panel').isVisible());
    await page.keyboard.press('?');
    assert.ok(await page.locator('#keys').isVisible());
    await page.keyboard.press('Escape');
    assert.ok(!await page.locator('#keys').isVisible());
});

test('every control can be reached by Tab, is named, and shows its focus', async t => {
    const page = await browser.open(t, small + '&move=0');
    const reached = new Map();
    for (let i = 0; i < 40; ++i) {
        await page.keyboard.press('Tab');
        const [id, name, outline] = await page.evaluate(() => {
            const {activeElement: at} = document;
            return [at.id || at.textContent, at.ariaLabel ?? at.labels?.[0]?.textContent ?? at.textContent,
                getComputedStyle(at).outlineStyle];
        });
        reached.set(id, [name.trim(), outline]);
    }
    for (const id of ['stage', 'fold', 'help', 'scene', 'view', 'lights', 'move', 'open', 'method', 'renderer', 'tile',
        'look', 'size', 'stops', 'compare']) {
        assert.ok(reached.has(id), `${id} is not reached`);
        assert.notEqual(reached.get(id)[0], '', `${id} has no name`);
        assert.notEqual(reached.get(id)[1], 'none', `${id} does not show its focus`);
    }
});

test('a layer of the plot can be hidden', async t => {
    const page = await browser.open(t, small);
    const draw = page.locator('#costs button', {hasText: 'Draw'});
    await wait_for_text(page, 'costs', /^(\D+\d+\.\d\d){5}$/);
    assert.match(await page.locator('#plot').getAttribute('aria-label'), /^Milliseconds a frame: .*Bin \d+\.\d\d/);
    const blue = () => page.locator('#plot').evaluate(plot => {
        const {data} = plot.getContext('2d').getImageData(0, 0, plot.width, plot.height);
        return data.some((_, i) => i % 4 === 0 && data[i] === 76 && data[i + 1] === 127 && data[i + 2] === 224);
    });
    assert.ok(await blue());
    await draw.click();
    assert.equal(await draw.getAttribute('aria-pressed'), 'false');
    assert.ok(!await blue());
});

test('the numbers are of the picture on show, not of those before', async t => {
    const page = await browser.open(t, small + '&move=0&method=box');
    const pre_pass = async () => parseFloat(await page.locator('#costs b').first().textContent());
    assert.ok(await pre_pass() > 0);
    await page.locator('#method').selectOption('z_bins');
    await page.waitForFunction(() => location.hash.includes('method=z_bins'));
    assert.equal(await pre_pass(), 0);
});

test('a link restores what it was made of', async t => {
    const hash = 'scene=street&view=1&move=0&method=z_bins&tile=24&look=heat&size=25&stops=1.5';
    const page = await browser.open(t, hash);
    await page.waitForFunction(() => document.getElementById('stats').textContent.startsWith('598 lights'));
    const values = {scene: 'street', view: '1', method: 'z_bins', look: 'heat', size: '25', stops: '1.5'};
    for (const [id, value] of Object.entries(values))
        assert.equal(await page.locator('#' + id).inputValue(), value, id);
    assert.deepEqual(new URL(page.url()).hash.slice(1).split('&').sort(), hash.split('&').sort());
});

for (const renderer of ['webgl', 'webgpu'])
    test(`${renderer}: a comparison ends when something else is chosen, and tells nothing`, async t => {
        const page = await browser.open(t, `renderer=${renderer}&lights=5000&size=50&tile=16&move=0`);
        await page.keyboard.press('c');
        await page.keyboard.press('c');  // there is one at a time
        await wait_for_text(page, 'verdict', /^Drawing with every light/);
        await page.locator('#scene').selectOption('nova');
        await wait_for_text(page, 'stats', /^255 lights/);
        assert.ok(!await page.locator('#verdict').isVisible());
        assert.equal(await page.locator('#compare').isDisabled(), false);
        assert.match(await compare(page), /^The same picture, byte by byte: 72,000 pixels/);
        assert.deepEqual(page.complaints, []);
    });

test('marks of a comparison go when another camera or file is chosen', async t => {
    const page = await browser.open(t, 'lights=16&view=2&size=20&tile=16&drop=3&move=0');
    assert.match(await compare(page), /differ/);
    await page.keyboard.press('1');
    await page.waitForFunction(() => !location.hash.includes('view'));
    assert.ok(!await page.locator('#differences').isVisible());
    assert.ok(!await page.locator('#verdict').isVisible());
});
