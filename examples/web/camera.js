// SPDX-License-Identifier: MIT
// A camera that orbits what it looks at, or flies; moved by mouse, fingers and keys.

const limit = (x, low, high) => Math.min(Math.max(x, low), high);

// Where it stands; yaw and pitch in radians; how far away the point is that it orbits, 0: none, it looks around.
export class FreeCamera {
    #lens = {orthographic: false, height: 1, near: 0.1, far: Infinity};
    #to_world = null;  // of the scene's camera, until it is moved
    #position = [0, 0, 0];
    #yaw = 0;
    #pitch = 0;
    #apart = 0;
    #size = 1;  // of the scene

    // A camera of a scene: {to_world, orthographic, height, near, far}. One that looks down orbits the scene's middle.
    start({to_world, orthographic, height, near, far}, {centre, radius}) {
        this.#lens = {orthographic, height, near, far};
        this.#to_world = Float64Array.from(to_world);
        this.#position = Array.from(this.#to_world.subarray(12, 15));
        const forward = Array.from(this.#to_world.subarray(8, 11), x => -x);
        this.#yaw = Math.atan2(-forward[0], -forward[2]);
        this.#pitch = Math.asin(limit(forward[1], -1, 1));
        this.#size = radius;
        const to_middle = forward.reduce((sum, x, i) => sum + x * (centre[i] - this.#position[i]), 0);
        this.#apart = forward[1] < -0.15 ? Math.max(to_middle, 0.1 * radius) : 0;
    }

    // What scenes.js and the renderers take. aspect: width / height of the picture; a narrow one sees as much across as
    // the scene's camera sees in its height.
    camera(aspect) {
        const wider = Math.max(1, 1 / aspect), {orthographic, height} = this.#lens;
        const angle = 2 * Math.atan(wider * Math.tan(height / 2));
        const lens = {...this.#lens, height: orthographic ? height * wider : Math.min(angle, 2.5)};
        if (this.#to_world) return {...lens, to_world: this.#to_world};
        const [right, up, back] = this.#axes();
        return {...lens, to_world: Float64Array.of(...right, 0, ...up, 0, ...back, 0, ...this.#position, 1)};
    }

    // As a text, for the page's address; '' where it was not moved.
    get place() {
        const numbers = [...this.#position, this.#yaw, this.#pitch, this.#apart, this.#lens.height];
        return this.#to_world ? '' : numbers.map(x => Number(x.toFixed(4))).join(',');
    }

    set place(text) {
        const numbers = text.split(',').map(Number);
        if (numbers.length !== 7 || !numbers.every(Number.isFinite)) return;
        [this.#position[0], this.#position[1], this.#position[2], this.#yaw, this.#pitch, this.#apart] = numbers;
        this.#lens.height = numbers[6];
        this.#to_world = null;
    }

    // Radians.
    turn(yaw, pitch) {
        this.#step(2, -this.#apart);
        this.#yaw += yaw;
        this.#pitch = limit(this.#pitch + pitch, -1.57, 1.57);
        this.#step(2, this.#apart);
    }

    // In heights of the picture.
    pan(x, y) {
        const apart = this.#apart || 0.1 * this.#size;
        const height = this.#lens.orthographic ? this.#lens.height : 2 * apart * Math.tan(this.#lens.height / 2);
        this.#step(0, -x * height);
        this.#step(1, y * height);
    }

    // Below 1: nearer.
    zoom(factor) {
        if (this.#lens.orthographic) {
            this.#lens.height *= factor;
            this.#step(2, 0);
        } else if (this.#apart * factor > 0.02 * this.#size) {
            this.#step(2, this.#apart * (factor - 1));
            this.#apart *= factor;
        } else {
            this.#step(2, 0.15 * this.#size * Math.log(factor));
        }
    }

    // In seconds of flight: to the right, up, and back.
    fly(x, y, z) {
        this.#apart = 0;
        [x, y, z].forEach((seconds, axis) => this.#step(axis, 0.12 * this.#size * seconds));
    }

    #axes() {
        const [cy, cp] = [this.#yaw, this.#pitch].map(Math.cos), [sy, sp] = [this.#yaw, this.#pitch].map(Math.sin);
        return [[cy, 0, -sy], [sy * sp, cp, cy * sp], [sy * cp, -sp, cy * cp]];
    }

    #step(axis, metres) {
        this.#to_world = null;
        const way = this.#axes()[axis];
        this.#position = this.#position.map((x, i) => x + metres * way[i]);
    }
}

// Mouse and fingers on `stage`.
export function listen_to_pointers(stage, camera) {
    const fingers = new Map();
    // The middle of the fingers, and how far they are from it.
    const spread = () => {
        const all = [...fingers.values()], mean = of => all.reduce((sum, finger) => sum + of(finger), 0) / all.length;
        const x = mean(finger => finger.x), y = mean(finger => finger.y);
        return {x, y, radius: mean(finger => Math.hypot(finger.x - x, finger.y - y))};
    };
    stage.addEventListener('pointerdown', event => {
        stage.setPointerCapture(event.pointerId);
        fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    stage.addEventListener('pointermove', event => {
        if (!fingers.has(event.pointerId)) return;
        const before = spread();
        fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
        const now = spread(), x = now.x - before.x, y = now.y - before.y;
        const height = stage.clientHeight;
        if (fingers.size === 1 && !(event.buttons & 6) && !event.shiftKey) {
            camera.turn(-3 * x / height, -3 * y / height);
            return;
        }
        camera.pan(x / height, y / height);
        if (fingers.size > 1) camera.zoom(limit(before.radius / now.radius || 1, 0.5, 2));
    });
    for (const end of ['pointerup', 'pointercancel'])
        stage.addEventListener(end, event => fingers.delete(event.pointerId));
    stage.addEventListener('contextmenu', event => event.preventDefault());
    stage.addEventListener('wheel', event => {
        event.preventDefault();
        const lines = event.deltaMode === 0 ? event.deltaY / 40 : event.deltaY;
        camera.zoom(Math.exp(limit(lines, -10, 10) * (event.ctrlKey ? 0.3 : 0.05)));  // ctrl: a pinch on a touchpad
    }, {passive: false});
}

const flying_keys = {
    KeyW: [2, -1], ArrowUp: [2, -1], KeyS: [2, 1], ArrowDown: [2, 1],
    KeyA: [0, -1], ArrowLeft: [0, -1], KeyD: [0, 1], ArrowRight: [0, 1], KeyQ: [1, -1], KeyE: [1, 1],
};

// Whether a key is not for the page: a control that has the focus wants it, or the browser.
export function is_wanted({target, key, ctrlKey, metaKey, altKey}) {
    if (ctrlKey || metaKey || altKey || target.closest?.('select, dialog')) return true;
    return key === ' ' ? target.closest?.('input, button') : key.length > 1 && target.closest?.('input');
}

// The keys that fly, as long as they are held.
export class FlyingKeys {
    #held = new Set();
    #hurry = 1;

    constructor() {
        addEventListener('keydown', event => {
            if (!flying_keys[event.code] || is_wanted(event)) return;
            event.preventDefault();
            this.#held.add(event.code);
        });
        for (const kind of ['keydown', 'keyup'])
            addEventListener(kind, event => { this.#hurry = event.shiftKey ? 4 : 1; });
        addEventListener('keyup', event => this.#held.delete(event.code));
        addEventListener('blur', () => this.#held.clear());
    }

    move(camera, seconds) {
        if (this.#held.size === 0) return;
        const way = [0, 0, 0];
        for (const [axis, sign] of [...this.#held].map(code => flying_keys[code])) way[axis] = sign;
        camera.fly(...way.map(sign => sign * this.#hurry * seconds));
    }
}
