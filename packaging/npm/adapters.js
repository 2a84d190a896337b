// SPDX-License-Identifier: MIT
// What the adapters share.

/// Options of a view whose tiles all list all lights of infinite range.
export const all_lights = {projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1],
                           clipDepth: 'minus-one-to-one', reversedZ: false};

/// Returns a function that warns of an error, and of what lightbin does then, once for each cause.
export function warner(what_it_does) {
    const causes = new Set();
    return ({code, message}) => {
        const cause = code ?? message;
        if (!causes.has(cause)) console.warn(`lightbin ${what_it_does}: ${message}`);
        causes.add(cause);
    };
}

/// Makes the slices of a picture again if its view has other depths, and returns whether it did. Those of a perspective
/// view are exponential, up to 100,000 times the near plane's depth.
///
/// picture     an object that holds the `slices`, and the `range` that these divide
/// least       the least depth that a perspective view's slices begin at
/// far         where slices end at the latest: an oblique near plane mostly leaves a view without an end
/// firstSlice  where the first slice of a perspective view ends
export function update_slices(lightbin, picture, view, {count, least, far = Infinity, firstSlice, margin = 0}) {
    const {nearDepth, farDepth, orthographic} = view.info;
    const near = Math.max(nearDepth, least), last = Math.max(Math.min(farDepth, far, near * 1e5), near * 2);
    const first = Math.max(Math.min(firstSlice ?? Math.sqrt(near * last) / 4, last / 2), near);
    // A margin is a part of the depth, so none at 0, where there may be a boundary of several slices.
    const linear = margin > 0 && nearDepth < 0 ? 1 : count;
    const range = orthographic ? {count: linear, begin: nearDepth, end: farDepth, margin}
        : {count, first, last, margin};
    if (JSON.stringify(range) === JSON.stringify(picture.range)) return false;
    const slices = orthographic ? lightbin.linearSlices(range) : lightbin.exponentialSlices(range);
    picture.slices?.dispose();
    Object.assign(picture, {slices, range});
    return true;
}
