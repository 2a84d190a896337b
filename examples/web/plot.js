// SPDX-License-Identifier: MIT
// What each frame cost: a small live plot, a column a frame, and the numbers.

const layers = [
    {name: 'pre_pass', title: 'Pre-pass', colour: '#8d97aa'},
    {name: 'lights', title: 'Lights', colour: '#4fd1c5'},
    {name: 'bin', title: 'Bin', colour: '#ffd166'},
    {name: 'upload', title: 'Upload', colour: '#c792ea'},
    {name: 'draw', title: 'Draw', colour: '#4c7fe0'},
];
const frames = 120, averaged = 60;

export class Plot {
    #canvas;
    #note;
    #costs = [];  // of the latest frames
    #shown = new Set(layers.map(layer => layer.name));
    #numbers = new Map();
    #most = 1;
    #written = 0;
    #of = '';
    #alike = 0;  // so many of the latest frames

    // `legend`: where the numbers go; each is a button that hides its layer, so that the others can be seen.
    constructor(canvas, legend, note) {
        this.#canvas = canvas;
        this.#note = note;
        for (const {name, title, colour} of layers) {
            const button = document.createElement('button');
            button.type = 'button';
            button.style.setProperty('--colour', colour);
            button.append(document.createElement('i'), ...['span', 'b'].map(kind => document.createElement(kind)));
            button.querySelector('span').textContent = title;
            button.setAttribute('aria-pressed', 'true');
            button.addEventListener('click', () => {
                const show = !this.#shown.delete(name);
                if (show) this.#shown.add(name);
                button.setAttribute('aria-pressed', String(show));
                this.#most = 0.01;
                this.#paint();
            });
            this.#numbers.set(name, button.querySelector('b'));
            legend.append(button);
        }
    }

    // ms: {pre_pass, lights, bin, upload, draw}; timed: how the drawing was, 'gpu' or 'wall'; of: what is drawn and
    // how, as a text: the numbers are of frames that are alike.
    add(ms, timed, of) {
        this.#alike = of === this.#of ? this.#alike + 1 : 1;
        this.#of = of;
        this.#costs.push(ms);
        if (this.#costs.length > frames) this.#costs.shift();
        this.#paint();
        if (this.#alike > 1 && performance.now() - this.#written < 250) return;  // as often as it can be read
        this.#written = performance.now();
        const means = layers.map(({name, title}) => [name, title, this.mean(name)]);
        for (const [name, , mean] of means) this.#numbers.get(name).textContent = mean.toFixed(2);
        this.#note.textContent = 'Milliseconds a frame. Draw: '
            + (timed === 'gpu' ? 'by the GPU\'s clock.' : 'until the GPU is done.');
        this.#canvas.setAttribute('aria-label', 'Milliseconds a frame: '
            + means.map(([, title, mean]) => `${title} ${mean.toFixed(2)}`).join(', '));
    }

    // Milliseconds, over the last second or so: clocks of browsers have coarse steps.
    mean(name) {
        const latest = this.#costs.slice(-Math.min(this.#alike, averaged));
        return latest.reduce((sum, ms) => sum + ms[name], 0) / latest.length;
    }

    #paint() {
        const canvas = this.#canvas, ratio = devicePixelRatio;
        const width = canvas.clientWidth, height = canvas.clientHeight;
        if (width === 0) return;  // it is hidden
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        const context = canvas.getContext('2d');
        context.scale(ratio, ratio);
        const shown = layers.filter(layer => this.#shown.has(layer.name));
        const sum = ms => shown.reduce((total, {name}) => total + ms[name], 0);
        const sums = this.#costs.map(sum).sort((a, b) => a - b);
        const high = sums[Math.floor(0.95 * sums.length)] ?? 1;  // single slow frames may stick out
        this.#most = Math.max(high * 1.15, 0.9 * this.#most, 0.01);

        const top = 14, y = ms => height - ms / this.#most * (height - top);
        const column = width / frames;
        this.#costs.forEach((ms, i) => {
            let base = 0;
            for (const {name, colour} of shown) {
                context.fillStyle = colour;
                const from = y(base), to = y(base += ms[name]);
                context.fillRect(width - (this.#costs.length - i) * column, to, Math.max(column - 0.5, 0.5), from - to);
            }
        });

        // A line at a round number.
        const unit = 10 ** Math.floor(Math.log10(this.#most)), units = this.#most / unit;
        const line = unit * (units >= 5 ? 5 : units >= 2 ? 2 : 1);
        context.fillStyle = 'rgb(255 255 255 / 35%)';
        context.fillRect(0, Math.round(y(line)), width, 1);
        context.fillStyle = '#c3cad7';
        context.font = '11px system-ui, sans-serif';
        context.fillText(`${Number(line.toPrecision(1))} ms`, 0, Math.round(y(line)) - 4);
    }
}
