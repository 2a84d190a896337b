// SPDX-License-Identifier: MIT
// What the latest frame was, in words over the picture.
import {by_id, counted} from './controls.js';

export class Summary {
    #frames = 0;
    #since = 0;
    #apart = 0;  // milliseconds from the last but one to the last

    // Counts a frame. Four times a second it is time for new words, and at once where nothing moves.
    is_due(moving) {
        ++this.#frames;
        this.#apart = performance.now() - this.#since;
        return this.#apart >= 250 || !moving;
    }

    // report: of renderer.draw(); about: what it was drawn with.
    show({in_view, rejected, longest, tiles_x, tiles_y}, about) {
        const {lights, bin, method, move, drop, look, renderer, width, height} = about;
        const place = method === 'clusters' ? 'cluster' : 'tile';
        by_id('stats').textContent = [
            counted(lights, 'light'), `${in_view.toLocaleString('en')} in view`,
            rejected > 0 ? `${rejected} skipped` : '', `${longest.toLocaleString('en')} a ${place} at most`,
            `bin\u00a0${bin.toFixed(2)}\u00a0ms`,
        ].filter(Boolean).join(', ');
        const rate = Math.round(1000 * this.#frames / this.#apart);
        by_id('frame').textContent = [
            renderer, `${width} \u00d7 ${height} pixels`, `${tiles_x} \u00d7 ${tiles_y} tiles`,
            move && this.#apart < 2000 ? `${counted(rate, 'frame')} a second` : '',
            drop >= 0 ? `light ${drop} left out of the lists` : '',
        ].filter(Boolean).join(', ');
        for (const name of ['heat', 'check']) by_id(`${name}_legend`).hidden = look !== name;
        by_id('longest').textContent = longest.toLocaleString('en');
        this.#frames = 0;
        this.#since += this.#apart;
    }
}
