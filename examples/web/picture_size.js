// SPDX-License-Identifier: MIT
// How large the picture is, over the window, where that is for the page to say: such that it moves fluently, and where
// nothing moves sharper, step by step.

const parts = [0.2, 0.28, 0.4, 0.56, 0.8, 1, 1.4, 2];  // of a side: each has twice the pixels of the one before
const still_after = 300, longest = 700;                // milliseconds

export class PictureSize {
    #fluent = 0;   // a place in `parts`,
    #sharper = 0;  // and steps above it
    #slow = 0;
    #quick = 0;
    #latest = 0;
    #moved_at = 0;

    get part() {
        return parts[this.#fluent + this.#sharper];
    }

    // There is something new to see.
    move() {
        this.#moved_at = performance.now();
        this.#sharper = 0;
    }

    // After a frame of so many milliseconds: whether another size is better. Three frames of 45 ms are too many, as is
    // one of 135; twelve below 14 ms leave time for the next size.
    judge(milliseconds) {
        this.#latest = milliseconds;
        if (this.#sharper > 0) return false;
        this.#slow = milliseconds > 45 ? this.#slow + milliseconds / 45 : 0;
        this.#quick = milliseconds < 14 ? this.#quick + (milliseconds < 4 ? 4 : 1) : 0;
        const step = this.#slow >= 3 ? -1 : this.#quick >= 12 ? 1 : 0;
        if (step === 0 || !parts[this.#fluent + step]) return false;
        this.#fluent += step;
        this.#slow = this.#quick = 0;
        return true;
    }

    // Takes a step to a sharper picture, if nothing has moved for a while and there is one that does not take too long.
    sharpen() {
        const next = this.#fluent + this.#sharper + 1;
        if (performance.now() - this.#moved_at < still_after || this.#latest > longest || !parts[next]) return false;
        ++this.#sharper;
        return true;
    }
}
