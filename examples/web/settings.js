// SPDX-License-Identifier: MIT
// What the page is set to: kept in its address, so that a link shows the same.

const fewest_lights = 16, most_lights = 50000;

const defaults = {
    scene: 'city',     // city, street, nova, darkness; file: one that was opened
    view: 0,           // the scene's camera,
    at: '',            // or where it was moved to
    lights: 10000,     // of the city
    move: true,
    method: 'clusters',
    tile: 32,
    renderer: 'webgl',
    look: 'lit',
    size: 'auto',      // or percent of the window's pixels
    stops: 0,          // brighter than the light meter says
    drop: -1,          // a light that is left out of the lists, to see the checks fail
};

const choices = {
    scene: ['city', 'street', 'nova', 'darkness'],
    method: ['none', 'z_bins', 'clusters', 'z_bounds'],
    renderer: ['webgl', 'webgpu'],
    look: ['lit', 'heat', 'check'],
};

const ranges = {
    view: [0, 1000], lights: [fewest_lights, most_lights], tile: [1, 4096], stops: [-5, 5], drop: [-1, 1e6],
};

// The settings that a page address's hash holds; what is missing or makes no sense is as by default.
export function parse_hash(hash) {
    const settings = {...defaults};
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) settings.move = false;
    for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ''))) {
        const number = Number(text), [low, high] = ranges[name] ?? [];
        const may_be = number >= low && number <= high && (name === 'stops' || Number.isInteger(number));
        if (choices[name]?.includes(text) || name === 'at') settings[name] = text;
        else if (name === 'move') settings.move = text !== '0';
        else if (name === 'size') settings.size = number >= 5 && number <= 200 ? String(number) : 'auto';
        else if (may_be) settings[name] = number;
    }
    return settings;
}

// A file that was opened is not in the link, nor where one looks at it from.
export function to_hash(settings) {
    const left_out = settings.scene === 'file' ? ['scene', 'view', 'at'] : [];
    const is_kept = ([name, value]) => value !== defaults[name] && !left_out.includes(name);
    const as_text = ([name, value]) => `${name}=${typeof value === 'boolean' ? Number(value) : value}`;
    return '#' + Object.entries(settings).filter(is_kept).map(as_text).join('&');
}

// The slider of lights goes by ratio, 0 to 1000; numbers of two digits and zeros are what it stops at.
export function lights_at(place) {
    const exact = fewest_lights * (most_lights / fewest_lights) ** (Math.min(Math.max(place, 0), 1000) / 1000);
    const unit = 10 ** Math.max(Math.floor(Math.log10(exact)) - 1, 0);
    return Math.round(exact / unit) * unit;
}

export function place_of(lights) {
    return Math.round(1000 * Math.log(lights / fewest_lights) / Math.log(most_lights / fewest_lights));
}
