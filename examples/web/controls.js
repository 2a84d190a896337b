// SPDX-License-Identifier: MIT
// The panel: what its controls show is what the settings say, and a control that is used changes them.
import {is_wanted} from './camera.js';
import {lights_at, place_of} from './settings.js';

export const by_id = id => document.getElementById(id);
export const counted = (n, what) => `${n.toLocaleString('en')} ${what}${n === 1 ? '' : 's'}`;
export const sentence = words => (/[.!?]$/.test(words) ? words : words + '.');

const selects = ['scene', 'method', 'renderer', 'look', 'size'];

export class Controls {
    #settings;
    #change;

    // change(names): called after settings of these names have changed. act: functions, open, compare, camera.
    constructor(settings, change, act) {
        this.#settings = settings;
        this.#change = change;
        for (const name of selects) by_id(name).addEventListener('change', () => this.set({[name]: by_id(name).value}));
        by_id('view').addEventListener('change', () => act.camera(Number(by_id('view').value)));
        by_id('lights').addEventListener('input', () => this.set({lights: lights_at(by_id('lights').value)}));
        for (const name of ['tile', 'stops'])
            by_id(name).addEventListener('input', () => this.set({[name]: Number(by_id(name).value)}));
        by_id('move').addEventListener('change', () => this.set({move: by_id('move').checked}));
        by_id('open').addEventListener('click', () => by_id('file').click());
        by_id('file').addEventListener('change', () => {
            const [file] = by_id('file').files;
            if (file) act.open(file);
            by_id('file').value = '';  // so that the same one can be chosen again
        });
        by_id('compare').addEventListener('click', act.compare);
        by_id('help').addEventListener('click', () => by_id('keys').showModal());
        by_id('fold').addEventListener('click', () => this.#fold());
        if (matchMedia('(max-width: 640px), (max-height: 480px) and (pointer: coarse)').matches) this.#fold();
        this.#listen_to_keys(act);
        this.#listen_to_drops(act);
        this.show();
    }

    set(values) {
        const changed = Object.keys(values).filter(name => this.#settings[name] !== values[name]);
        Object.assign(this.#settings, values);
        this.show();
        if (changed.length > 0) this.#change(changed);
    }

    show() {
        const settings = this.#settings;
        for (const name of selects) by_id(name).value = settings[name];
        // A size of the page's address that is no choice here.
        if (by_id('size').value === '') {
            by_id('size').add(new Option(settings.size + ' %', settings.size));
            by_id('size').value = settings.size;
        }
        by_id('view').value = settings.at === '' ? settings.view : '';
        by_id('lights_row').hidden = settings.scene !== 'city';
        if (lights_at(by_id('lights').value) !== settings.lights) by_id('lights').value = place_of(settings.lights);
        by_id('lights_out').textContent = settings.lights.toLocaleString('en');
        by_id('lights').setAttribute('aria-valuetext', counted(settings.lights, 'light'));
        by_id('tile').value = settings.tile;
        by_id('tile_out').textContent = `${settings.tile} pixels`;
        by_id('stops').value = settings.stops;
        const stops = `${settings.stops > 0 ? '+' : ''}${settings.stops} stops`;
        by_id('stops_out').textContent = settings.stops === 0 ? 'as metered' : stops;
        by_id('move').checked = settings.move;
    }

    show_scene({name, notes, cameras}, is_file) {
        by_id('scene').querySelector('[value=file]')?.remove();
        if (is_file) by_id('scene').add(new Option(name, 'file'));
        by_id('view').replaceChildren(...cameras.map((camera, i) => new Option(camera.name || `Camera ${i + 1}`, i)),
            new Option('moved', ''));
        by_id('view').lastChild.hidden = true;
        by_id('notes').textContent = notes.join('\n');
        by_id('notes').hidden = notes.length === 0;
        this.show();
    }

    // reasons: by the depth method that can't be had.
    refuse_methods(reasons) {
        for (const option of by_id('method').options) option.disabled = option.value in reasons;
        this.#say_refused('method', Object.values(reasons)[0]);
    }

    refuse_webgpu(reason) {
        by_id('renderer').options[1].disabled = reason !== null;
        this.#say_refused('webgpu', reason && `WebGPU can't be had here: ${reason}`);
    }

    #refused = {};
    #say_refused(what, reason) {
        this.#refused[what] = reason ? sentence(reason) : '';
        const lines = Object.values(this.#refused).filter(line => line !== '');
        by_id('refused').textContent = lines.join('\n');
        by_id('refused').hidden = lines.length === 0;
    }

    #fold() {
        const folded = document.body.classList.toggle('folded');
        by_id('fold').setAttribute('aria-expanded', String(!folded));
        by_id('fold').textContent = folded ? 'Controls' : 'Hide';
    }

    #listen_to_keys(act) {
        const settings = this.#settings;
        const step_tile = by => this.set({tile: Math.min(Math.max(settings.tile + by, 8), 128)});
        const more_lights = by => {
            if (settings.scene === 'city') this.set({lights: lights_at(place_of(settings.lights) + by)});
        };
        const look = name => this.set({look: settings.look === name ? 'lit' : name});
        const next_method = () => {
            const possible = [...by_id('method').options].filter(({disabled}) => !disabled).map(({value}) => value);
            this.set({method: possible[(possible.indexOf(settings.method) + 1) % possible.length]});
        };
        const keys = {
            ' ': () => this.set({move: !settings.move}), '+': () => more_lights(40), '=': () => more_lights(40),
            '-': () => more_lights(-40), '[': () => step_tile(-8), ']': () => step_tile(8), 'm': next_method,
            'h': () => look('heat'), 'l': () => look('check'), 'c': act.compare, 'p': () => this.#fold(),
            '?': () => by_id('keys').showModal(),
        };
        addEventListener('keydown', event => {
            if (is_wanted(event)) return;
            const key = event.key.toLowerCase();
            if (key >= '1' && key <= '9') act.camera(Number(key) - 1);
            else if (keys[key]) keys[key]();
            else return;
            event.preventDefault();
        });
    }

    #listen_to_drops(act) {
        const show = shown => { by_id('drop').hidden = !shown; };
        addEventListener('dragover', event => {
            event.preventDefault();
            show(true);
        });
        addEventListener('dragleave', event => event.relatedTarget === null && show(false));
        addEventListener('drop', event => {
            event.preventDefault();
            show(false);
            const [file] = event.dataTransfer.files;
            if (file) act.open(file);
        });
    }
}
