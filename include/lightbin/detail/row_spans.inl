// SPDX-License-Identifier: MIT
// The row spans of lights in view. Included once a tier, after what their silhouettes are: SphereRows and SpotRows.

/// Writes the row spans of the lights in view in a run, from spans[place] on; whole vectors are stored. A light gets none
/// where they could drop nothing or can't be numbered. A sphere's row has at least one tile.
template <class Rows>
LIGHTBIN_TARGET inline void row_spans(const Camera& camera, const FootprintArrays& lights, FootprintRun run,
                                      RowSpan* spans, std::uint64_t place) {
    static constexpr double count_up[] = {0, 1, 2, 3, 4, 5, 6, 7};
    const Doubles lane = load_doubles(count_up);
    const double row_offset = camera.y.offset, per_scale = 1 / camera.y.scale;
    Rows rows;
    for (std::uint32_t begin = run.begin; begin < run.end; begin += lanes) {
        const std::uint32_t used = run.end - begin < lanes ? run.end - begin : lanes;
        const unsigned known = rows.find(camera, lights, begin, used);
        for (std::uint32_t i = 0; i < used; ++i) {
            const unsigned x0 = lights.x0[begin + i], x1 = lights.x1[begin + i], y0 = lights.y0[begin + i],
                           y1 = lights.y1[begin + i];
            std::uint32_t& first = lights.span_begin[begin + i];
            first = FootprintArrays::whole_rectangle;
            if ((known >> i & 1) == 0 || x0 == x1 || y0 == y1 || place + (y1 - y0) >= first) continue;
            first = static_cast<std::uint32_t>(place);
            const Doubles leftmost = all(static_cast<double>(x0)), rightmost = all(static_cast<double>(x1));
            for (unsigned row = y0; row <= y1; row += double_lanes) {
                const Doubles edge = lane + (static_cast<double>(row) - row_offset);
                rows.store(i, edge * per_scale, (edge + 1.0) * per_scale, leftmost, rightmost,
                           spans + place + (row - y0));
            }
            place += y1 - y0 + 1;
        }
    }
}
