// SPDX-License-Identifier: MIT
// project_scalar, a vector of lights at a time: the same operations in the same order, so the same bytes.
// Included once a tier, between definitions of the tier's vectors; see kernels.hpp. Lights that
// project_sphere hands to project_carefully go there one by one.

/// Writes the tiles of one axis; lanes of `visible` that are out of the viewport are taken out of it.
LIGHTBIN_TARGET inline Mask tile_span(const ImageAxis& axis, Floats low, Floats high, Mask visible,
                                      std::uint16_t* first, std::uint16_t* last) {
    const Floats scale = all(axis.scale_f), offset = all(axis.offset_f), margin = all(axis.margin);
    low = sub(add(mul(low, scale), offset), margin);
    high = add(add(mul(high, scale), offset), margin);
    const Floats zero = all(0), inside = all(axis.inside);
    store_tiles(first, lesser(greater(low, zero), inside));
    store_tiles(last, lesser(high, inside));
    return both(visible, both(less_equal(zero, high), less_equal(low, all(axis.limit))));
}

/// As the scalar tangent_slopes.
LIGHTBIN_TARGET inline void tangent_slopes(Floats c, Floats z, Floats r, Floats e, Floats& low,
                                           Floats& high) {
    const Floats a = abs(c);
    const Floats tangent_length = sqrt(add(mul(a, a), e));
    const Floats q = add(mul(a, z), mul(r, tangent_length));
    const Floats outer = div(q, e);
    const Floats inner = div(mul(sub(a, r), add(a, r)), q);
    const Mask negative = less(c, all(0));
    low = select(negative, negate(outer), inner);
    high = select(negative, negate(inner), outer);
}

LIGHTBIN_TARGET inline void project(const Camera& camera, const Sphere* spheres, std::uint32_t count,
                             std::uint32_t first_id, const FootprintArrays& out, ProjectCounts& counts) {
    Sphere padded[lanes];
    for (std::uint32_t i = 0; i < count; i += lanes) {
        const std::uint32_t used = count - i < lanes ? count - i : lanes;
        const Sphere* block = spheres + i;
        if (used < lanes) {
            for (std::uint32_t lane = 0; lane < lanes; ++lane)
                padded[lane] = block[lane < used ? lane : 0];
            block = padded;
        }
        Floats x, y, z, r;
        load_spheres(block, x, y, z, r);
        x = mul(x, all(camera.x.sign));
        y = mul(y, all(camera.y.sign));
        z = mul(z, all(camera.z_sign));
        const Floats nearest = sub(z, r), farthest = add(z, r);
        const Mask usable = both(less_equal(add(add(add(abs(x), abs(y)), abs(z)), r), all(0x1p40f)),
                                 less_equal(all(0x1p-40f), r));
        const Mask culled =
            either(less(farthest, all(camera.near_depth)), less(all(camera.far_depth), nearest));
        Mask plain = both_not(usable, culled);
        Mask settled = usable;  // the others need project_carefully
        Floats low_x, high_x, low_y, high_y;
        if (camera.orthographic) {
            low_x = sub(x, r);
            high_x = add(x, r);
            low_y = sub(y, r);
            high_y = add(y, r);
        } else {
            const Mask beyond = less(all(camera.near_fast), nearest);
            settled = both(usable, either(culled, beyond));
            plain = both(plain, beyond);
            const Floats e = mul(nearest, farthest);
            tangent_slopes(x, z, r, e, low_x, high_x);
            tangent_slopes(y, z, r, e, low_y, high_y);
        }
        LaneRects<lanes> rects;
        plain = tile_span(camera.x, low_x, high_x, plain, rects.x0, rects.x1);
        plain = tile_span(camera.y, low_y, high_y, plain, rects.y0, rects.y1);

        const unsigned valid = (1u << used) - 1;
        unsigned visible = bits(plain) & valid;
        for (unsigned rest = ~bits(settled) & valid; rest != 0; rest &= rest - 1) {
            const unsigned lane = static_cast<unsigned>(std::countr_zero(rest));
            TileRect rect;
            const Visibility visibility = project_carefully(camera, block[lane], rect);
            counts.rejected += visibility == Visibility::rejected;
            if (visibility != Visibility::visible) continue;
            rects.x0[lane] = rect.x0;
            rects.y0[lane] = rect.y0;
            rects.x1[lane] = rect.x1;
            rects.y1[lane] = rect.y1;
            visible |= 1u << lane;
        }
        if (visible == 0) continue;
        append_visible(out, counts, first_id + i, visible, rects);
    }
}
