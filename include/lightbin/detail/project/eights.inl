// SPDX-License-Identifier: MIT
// For the scalar tier: lights are moved, and asked whether they are out of view, eight at a time, in loops that compilers
// make vectors of. Included once a tier, before project.inl.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/common.inl>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Moves eight spheres as move_spheres does, for the scalar tier: loops that compilers make vectors of, if the products
/// are kept apart from the sums.
LIGHTBIN_NOINLINE inline void move_eight(const WorldToView& to_view, const Sphere* given,
                                                         Sphere* moved) {
    const FloatMove move = to_view.floats();
    float away[8], radius[8], from_origin[3][8], products[11][8];
    for (int i = 0; i < 8; ++i) {
        const Sphere sphere = load_sphere(given + i);
        from_origin[0][i] = sphere.x - move.origin[0];
        from_origin[1][i] = sphere.y - move.origin[1];
        from_origin[2][i] = sphere.z - move.origin[2];
        radius[i] = sphere.radius;
    }
    int plain[8], all_plain = 1;
    for (int i = 0; i < 8; ++i) {
        away[i] = abs_of(from_origin[0][i]) + abs_of(from_origin[1][i]) + abs_of(from_origin[2][i]);
        plain[i] = (away[i] <= move.most) & (radius[i] >= least_plain) &
                   (radius[i] <= most_plain);
        all_plain &= plain[i];
    }
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            for (int i = 0; i < 8; ++i)
                products[3 * row + column][i] = from_origin[column][i] * move.columns[column][row];
    for (int i = 0; i < 8; ++i) {
        products[9][i] = radius[i] * move.stretch;
        products[10][i] = away[i] * move.error;
    }
    LIGHTBIN_FORGET_ARRAY(products);
    float centre[3][8];
    for (int row = 0; row < 3; ++row)
        for (int i = 0; i < 8; ++i)
            centre[row][i] = products[3 * row][i] + products[3 * row + 1][i] + products[3 * row + 2][i] +
                             move.at_origin[row];
    for (int i = 0; i < 8; ++i)
        radius[i] = products[9][i] + (products[10][i] + move.least_error);
    Sphere after[8];
    for (int i = 0; i < 8; ++i)
        after[i] = {centre[0][i], centre[1][i], centre[2][i], radius[i]};
    if (all_plain == 0)
        for (int i = 0; i < 8; ++i)
            if (plain[i] == 0) after[i] = to_view(load_sphere(given + i));
    copy_items(after, 8, moved);
}
inline void move_in_eights(const WorldToView& to_view, const Sphere* given,
                                           std::uint32_t count, Sphere* moved) {
    for (; count >= 8; count -= 8, given += 8, moved += 8)
        move_eight(to_view, given, moved);
    if (count == 0) return;
    Sphere rest[8];
    for (std::uint32_t i = 0; i < 8; ++i)
        rest[i] = load_sphere(given + (i < count ? i : 0));
    move_eight(to_view, rest, rest);
    copy_items(rest, count, moved);
}

/// Whether eight spheres are out of view beyond doubt, for the scalar tier: a loop that compilers make vectors of,
/// and not inline, as within another they don't. They may fuse products and sums there, so it asks for twice the
/// distance to a side plane that project does: what is out here is out there.
LIGHTBIN_NOINLINE inline bool eight_out_of_view(const Camera& camera, const Sphere* spheres) {
    Sphere eight[8];
    std::memcpy(eight, spheres, sizeof eight);
    int out = 1;
    for (const Sphere& sphere : eight) {
        const float a = abs_of(sphere.x), b = abs_of(sphere.y), z = sphere.z * camera.z_sign;
        const float r = sphere.radius, size = a + b + abs_of(z) + r;
        const float aside_x = a * camera.x.side + z * camera.x.side_z - r;
        const float aside_y = b * camera.y.side + z * camera.y.side_z - r;
        out &= (size <= most_plain) & (r >= least_plain) &
               ((z + r < camera.near_depth) | (z - r > camera.far_depth) |
                ((aside_x > aside_y ? aside_x : aside_y) > size * 0x1p-20f));
    }
    return out != 0;
}

/// Copies and moves lights to `to`, for the scalar tier.
inline void take(const LightSource& source, std::uint32_t first, std::uint32_t count, const Sphere* given,
                 Sphere* to) {
    if (source.copy != nullptr) source.copy(source.lights, first, count, to, nullptr);
    if (source.to_view != nullptr) move_in_eights(*source.to_view, given, count, to);
}

}}}}  // namespace lightbin::detail
