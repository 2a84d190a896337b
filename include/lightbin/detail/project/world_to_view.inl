// SPDX-License-Identifier: MIT
// World to view space, a vector of lights at a time: world_to_view.hpp says how it rounds. Included once a tier, after
// its vectors.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// A map's numbers in every lane.
struct MoveLanes {
    explicit MoveLanes(const WorldToView* from) : to_view(from) {
        if (from == nullptr) return;
        const FloatMove& move = from->floats();
        for (unsigned row = 0; row < 3; ++row) {
            origin[row] = broadcast(move.origin[row]);
            at_origin[row] = broadcast(move.at_origin[row]);
            for (unsigned column = 0; column < 3; ++column)
                columns[column][row] = broadcast(move.columns[column][row]);
        }
        stretch = broadcast(move.stretch);
        error = broadcast(move.error);
        least_error = broadcast(move.least_error);
        bend = broadcast(move.bend);
        most = broadcast(move.most);
    }

    const WorldToView* to_view;
    Floats origin[3], columns[3][3], at_origin[3], stretch, error, least_error, bend, most;
};

/// Moves those of a vector's spheres one by one that floats can't hold or would blur.
LIGHTBIN_NOINLINE inline void move_carefully(const WorldToView& to_view, unsigned which,
                                                             const Floats (&given)[4], Floats (&moved)[4]) {
    Sphere before[lanes], after[lanes];
    store_spheres(before, given[0], given[1], given[2], given[3]);
    store_spheres(after, moved[0], moved[1], moved[2], moved[3]);
    for (; which != 0; which &= which - 1)
        after[std::countr_zero(which)] = to_view(before[std::countr_zero(which)]);
    load_spheres(after, moved[0], moved[1], moved[2], moved[3]);
}

/// A row of A p.
inline Floats moved_direction(const MoveLanes& move, unsigned row, Floats x, Floats y,
                                              Floats z) {
    return mul(x, move.columns[0][row]) + mul(y, move.columns[1][row]) + mul(z, move.columns[2][row]);
}

/// Moves spheres. Left to themselves, compilers make it a call, by way of memory.
LIGHTBIN_INLINE void move_spheres(const MoveLanes& move, Floats& x, Floats& y, Floats& z,
                                                  Floats& radius) {
    const Floats dx = x - move.origin[0], dy = y - move.origin[1], dz = z - move.origin[2];
    const Floats away = abs(dx) + abs(dy) + abs(dz);
    const auto plain = both(less_equal(away, move.most),
                            both(less_equal(broadcast(float_safe_min), radius), less_equal(radius, broadcast(float_safe_max))));
    const Floats given[] = {x, y, z, radius};
    x = moved_direction(move, 0, dx, dy, dz) + move.at_origin[0];
    y = moved_direction(move, 1, dx, dy, dz) + move.at_origin[1];
    z = moved_direction(move, 2, dx, dy, dz) + move.at_origin[2];
    radius = mul(radius, move.stretch) + (mul(away, move.error) + move.least_error);
    const unsigned rest = ~movemask(plain) & static_cast<unsigned>(every_lane);
    if (rest == 0) return;
    Floats moved[] = {x, y, z, radius};
    move_carefully(*move.to_view, rest, given, moved);
    x = moved[0];
    y = moved[1];
    z = moved[2];
    radius = moved[3];
}

}}}}  // namespace lightbin::detail
