// SPDX-License-Identifier: MIT
// What the page finds out from pictures that it reads back: how bright they should be, and whether they are right.

// Three quarters of what is lit stay below the middle of the display's range, whatever unit the scene's lights are in.
// Found by small pictures, until one is neither too dark nor too bright to tell.
export async function meter(renderer, lighting, settings) {
    const small = {...settings, width: 96, height: 54, tile_size: 8, look: 'lit', show: false};
    let exposure = 1;
    for (let tries = 0; tries < 12; ++tries) {
        await renderer.draw(lighting, {...small, exposure});
        const bytes = await renderer.read(), lit = [];
        for (let i = 0; i < bytes.length; i += 4) {
            const brightest = Math.max(bytes[i], bytes[i + 1], bytes[i + 2]);
            if (brightest > 64) lit.push(brightest);  // more than moonlight
        }
        const level = lit.sort((a, b) => a - b)[Math.floor(0.75 * lit.length)];
        if (lit.length < 50 || level > 245) {
            exposure *= lit.length < 50 ? 8 : 1 / 8;
            continue;
        }
        const wanted = 0.5 / -Math.log(1 - (level / 255) ** 2.2);
        exposure *= wanted;
        if (wanted > 0.8 && wanted < 1.25) return exposure;
    }
    return exposure < 1e-6 || exposure > 1e6 ? 1 : exposure;  // nothing is lit
}

// Draws with lists and with every light, and compares the pictures byte by byte. `overlay` shows where they differ.
// Returns {pixels, different, largest, milliseconds: [lists, every]}.
export async function compare(renderer, lighting, settings, overlay) {
    const pictures = [], milliseconds = [];
    for (const every_light of [false, true]) {
        const begun = performance.now();
        await renderer.draw(lighting, {...settings, look: 'lit', every_light, show: !every_light});
        pictures.push(await renderer.read());
        milliseconds.push(performance.now() - begun);
    }
    const {width, height} = settings, marks = new ImageData(width, height);
    const [a, b] = pictures, [whole_a, whole_b] = pictures.map(picture => new Uint32Array(picture.buffer));
    let different = 0, largest = 0;
    for (let pixel = 0; pixel < width * height; ++pixel) {
        if (whole_a[pixel] === whole_b[pixel]) continue;
        ++different;
        for (let i = 4 * pixel; i < 4 * pixel + 4; ++i) largest = Math.max(largest, Math.abs(a[i] - b[i]));
        const y = Math.floor(pixel / width), row = renderer.rows_from_below ? height - 1 - y : y;
        marks.data.set([255, 60, 245, 255], 4 * (row * width + pixel % width));
    }
    overlay.width = width;
    overlay.height = height;
    overlay.getContext('2d').putImageData(marks, 0, 0);
    return {pixels: width * height, different, largest, milliseconds};
}
