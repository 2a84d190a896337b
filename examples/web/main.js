// SPDX-License-Identifier: MIT
// The page: start() has how it begins, and run() a frame from top to bottom.
import {FlyingKeys, FreeCamera, listen_to_pointers} from './camera.js';
import {compare, meter} from './checks.js';
import {by_id, Controls, counted, sentence} from './controls.js';
import {load_lighting} from './lighting.js';
import {PictureSize} from './picture_size.js';
import {Plot} from './plot.js';
import {parse_hash, to_hash} from './settings.js';
import {Summary} from './summary.js';
import {WebGl} from './webgl.js';

const stage = by_id('stage');
const settings = parse_hash(location.hash);
const eye = new FreeCamera(), flying = new FlyingKeys();
const plot = new Plot(by_id('plot'), by_id('costs'), by_id('costs_note'));
const summary = new Summary(), picture_size = new PictureSize();
const jobs = new Set();  // what is to be done before the next frame
let controls, lighting, renderer;
let scene = null;  // what scenes.js tells of the one on show; `of` is its name in the settings
let exposure = 1;
let seconds = 0;    // how long the lights have moved
let stale = true;   // the picture is not that of the settings
let held = false;   // nor is it to be: there is something to look at

// What is wrong, in a sentence; none: nothing is.
function complain(words = '') {
    if (by_id('alert').textContent === words) return;  // it is not to be read out again
    by_id('alert').textContent = words;
    by_id('alert').hidden = words === '';
}

function tell(sentence = '', differs = false) {
    by_id('verdict').hidden = sentence === '';
    by_id('verdict').classList.toggle('differs', differs);
    by_id('verdict').firstElementChild.textContent = sentence;
    by_id('differences').hidden = !differs;
    held = differs;
}

// `part`: that of a picture whose size keeps the page fluent. Its tiles are as small: else each had the lights of many.
function frame_settings(part = picture_size.part) {
    const {method, look, drop, stops, size} = settings;
    if (size !== 'auto') part = size / 100;
    const tile_size = size === 'auto' ? Math.max(Math.round(settings.tile * part), 4) : settings.tile;
    const [width, height] = [stage.clientWidth, stage.clientHeight].map(side => Math.max(Math.round(side * part), 16));
    return {
        camera: eye.camera(width / height), width, height, tile_size, method, look, drop, seconds,
        exposure: exposure * 2 ** stops,
    };
}

// The picture is not that of the settings any more.
function renew() {
    stale = true;
    picture_size.move();
}

async function fetched(url) {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url} could not be fetched.`);
    return new Uint8Array(await response.arrayBuffer());
}

// Where the scene can't be had, the one on show stays.
async function show_scene() {
    const {scene: name} = settings;
    try {
        if (name === 'city' || name === 'street') lighting.scenes.make(name, settings.lights);
        else if (name !== 'file') lighting.scenes.open(await fetched(`${name}.glb`), name);
    } catch (error) {
        settings.scene = scene?.of ?? 'city';
        controls.show();
        throw error;
    }
    take_scene(name);
    await go_to(settings.view);
}

function take_scene(of) {
    const {triangles, glass, has_spots, ...told} = lighting.scenes.scene;
    renderer.set_scene({triangles, glass, has_spots});
    scene = {...told, of};
    controls.show_scene(scene, of === 'file');
}

// Other lights in the same city, seen from where one is.
async function change_lights() {
    lighting.scenes.make('city', settings.lights);
    take_scene('city');
}

async function open_file(file) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    try {
        lighting.scenes.open(bytes, file.name);
    } catch (error) {
        throw new Error(`Can't show ${error.message}`);
    }
    Object.assign(settings, {scene: 'file', at: ''});
    take_scene('file');
    await go_to(0);
}

async function go_to(view) {
    settings.view = Math.min(view, scene.cameras.length - 1);
    eye.start(scene.cameras[settings.view], scene);
    eye.place = settings.at;
    controls.show();
    exposure = await meter(renderer, lighting, frame_settings());
    renew();
}

// The camera was moved.
function look_from(place) {
    settings.at = place;
    controls.show();
    if (held) tell();
    renew();
}

async function use_renderer() {
    const canvas = document.createElement('canvas');
    const gpu = settings.renderer === 'webgpu';
    try {
        const made = await (gpu ? (await import('./webgpu.js')).WebGpu : WebGl).create(canvas);
        renderer?.destroy();
        renderer = made;
    } catch (error) {
        if (!gpu) throw error;
        controls.refuse_webgpu(error.message);
        settings.renderer = 'webgl';
        controls.show();
        if (!renderer) await use_renderer();
        return;
    }
    stage.replaceChildren(canvas);
    controls.refuse_methods(renderer.refused);
    if (settings.method in renderer.refused) controls.set({method: 'clusters'});
    if (scene) take_scene(scene.of);
    renew();
}

// Ends early, with nothing to tell, when its announcement is closed: by a button, or as something else was chosen.
async function check() {
    const wanted = () => !by_id('verdict').hidden;
    renew();  // not for the sharper picture: every light in each of its pixels takes long
    try {
        await new Promise(requestAnimationFrame);  // so that this can be read
        const found = await compare(renderer, lighting, {...frame_settings(), wanted}, by_id('differences'));
        if (!wanted()) return;
        const of_all = `${found.different.toLocaleString('en')} of ${counted(found.pixels, 'pixel')}`;
        const [lists, every] = found.milliseconds.map(ms => `${Math.round(ms).toLocaleString('en')} ms`);
        const times = ` With lists ${lists}, with every light ${every}.`;
        const but_for_rounding = `but for 1 of 255 in ${of_all}: two shaders may be rounded differently`;
        if (found.different === 0) tell(`The same picture, byte by byte: ${counted(found.pixels, 'pixel')}.${times}`);
        else if (found.largest === 1) tell(`The same picture ${but_for_rounding}.${times}`);
        else tell(`${of_all} differ, by up to ${found.largest} of 255: see the marks.`, true);
    } catch (error) {
        tell();
        throw error;
    } finally {
        by_id('compare').disabled = false;
    }
}

const actions = {
    open: file => {
        complain();
        tell();
        jobs.add(() => open_file(file));
    },
    compare: () => {
        if (by_id('compare').disabled) return;
        by_id('compare').disabled = true;
        tell('Drawing with every light');
        jobs.add(check);
    },
    camera: view => {
        if (view >= scene.cameras.length) return;
        settings.at = '';
        tell();
        jobs.add(() => go_to(view));
    },
};

function change(names) {
    complain();
    tell();
    renew();
    if (names.includes('scene')) Object.assign(settings, {view: 0, at: ''});
    const by_name = {scene: show_scene, lights: change_lights, renderer: use_renderer};
    for (const name of names) if (by_name[name]) jobs.add(by_name[name]);
}

// exact: what it reports is of this very frame.
async function draw(exact) {
    const frame = {...frame_settings(), exact};
    const slow = setTimeout(() => by_id('frame').textContent = 'Drawing, which takes a while here', 1000);
    const report = await renderer.draw(lighting, frame).finally(() => clearTimeout(slow));
    const {method, look, width, height, tile_size} = frame;
    const of = [renderer.name, scene.of, scene.lights, settings.view, method, look, width, height, tile_size].join();
    plot.add(report.ms, report.timed, of);
    if (summary.is_due(settings.move)) {
        const {lights} = scene, {name} = renderer;
        summary.show(report, {...settings, ...frame, lights, renderer: name, bin: plot.mean('bin')});
        const hash = to_hash(settings);
        if (hash !== location.hash) history.replaceState(null, '', hash);
    }
    const better = picture_size.judge(Object.values(report.ms).reduce((sum, ms) => sum + ms));
    if (better && settings.size === 'auto') stale = true;
}

// A graphics context may come back, see start(); a device of WebGPU does not.
function go_on_without() {
    if (settings.renderer === 'webgpu') {
        controls.refuse_webgpu(renderer.lost);
        settings.renderer = 'webgl';
        jobs.add(use_renderer);
    } else {
        complain(renderer.lost);
    }
}

async function run() {
    let failed = false;  // not tried again until something changes
    for (let last = performance.now(); ;) {
        const now = await new Promise(requestAnimationFrame), elapsed = Math.min(Math.max(now - last, 0), 100) / 1000;
        last = now;
        try {
            for (const job of jobs) {
                jobs.delete(job);
                await job();
            }
            if (renderer.lost) {
                go_on_without();
                continue;
            }
            flying.move(eye, elapsed);
            if (settings.at !== eye.place) look_from(eye.place);
            if (held || (failed && !stale)) continue;
            const still = !stale && !settings.move;
            if (still && !(settings.size === 'auto' && picture_size.sharpen())) continue;
            if (settings.move) seconds += elapsed;
            stale = false;
            failed = true;
            await draw(still);
            failed = false;
        } catch (error) {
            complain(sentence(error.message));
        }
    }
}

async function look_for_webgpu() {
    if (!navigator.gpu) controls.refuse_webgpu('this browser does not have it');
    else if (!await navigator.gpu.requestAdapter().catch(() => null))
        controls.refuse_webgpu('no graphics adapter has it');
}

async function start() {
    controls = new Controls(settings, change, actions);
    by_id('close_verdict').addEventListener('click', () => tell());
    listen_to_pointers(stage, eye);
    addEventListener('resize', () => change([]));
    addEventListener('hashchange', () => location.reload());  // somebody changed the address
    // It does not bubble, but can be caught on its way down.
    stage.addEventListener('webglcontextrestored', () => jobs.add(async () => {
        await use_renderer();
        complain();
    }), true);
    try {
        [lighting] = await Promise.all([load_lighting(), use_renderer()]);
        await show_scene().catch(async error => {
            complain(sentence(error.message));
            await show_scene();
        });
        await draw(false).catch(error => complain(sentence(error.message)));  // another tile size may help
    } catch (error) {
        document.body.classList.add('cannot');
        complain(`${sentence(error.message)} The page needs WebGL 2 and WebAssembly with exceptions: Chrome or Edge 95, `
            + 'Firefox 100, Safari 16.4, or later, with graphics switched on.');
        return;
    }
    performance.mark('first picture');
    look_for_webgpu();
    run();
}

start();
