// SPDX-License-Identifier: MIT
// Whether balls meet parts of a camera's image: by the filter where it has an answer, else by rationals.
#pragma once

#include "filter.hpp"
#include "oracle.hpp"

#include <cstdint>
#include <optional>
#include <stdexcept>

namespace oracle {

/// The tiles of columns [x0, x1) and rows [y0, y1).
struct Block {
    int x0, x1, y0, y1;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

/// All questions about one camera. Depths and balls are given in double, and by functions that return the same in
/// rationals, which are called where they are needed.
class Truth {
public:
    explicit Truth(const Camera& camera) : oracle(camera), range(oracle.range()), filter(oracle) {}
    Truth(const Truth&) = delete;  // the filter refers to the oracle
    Truth& operator=(const Truth&) = delete;

    template <class ExactDepths, class ExactBall>
    bool meets(const Block& b, const FlatDepths& depths, const FlatBall& ball, ExactDepths exact_depths,
               ExactBall exact_ball) {
        return !b.empty() && settle(filter.meets(b.x0, b.x1, b.y0, b.y1, depths, ball), [&] {
            return oracle::meets({columns(b.x0, b.x1), rows(b.y0, b.y1)}, exact_depths(), exact_ball());
        });
    }

    /// What a rectangle tests, one image axis at a time: the wedge of whole columns (rows) of tiles, from the near to the
    /// far plane.
    template <class ExactBall>
    bool meets_columns(int x0, int x1, const FlatBall& ball, ExactBall exact_ball) {
        return x0 < x1 && settle(filter.meets_columns(x0, x1, range, ball), [&] {
            return oracle::meets({columns(x0, x1), {}}, oracle.range(), exact_ball());
        });
    }
    template <class ExactBall> bool meets_rows(int y0, int y1, const FlatBall& ball, ExactBall exact_ball) {
        return y0 < y1 && settle(filter.meets_rows(y0, y1, range, ball), [&] {
            return oracle::meets({{}, rows(y0, y1)}, oracle.range(), exact_ball());
        });
    }

    /// The answer in double precision, or where there is none, and now and then as a check, the exact one.
    template <class Exact> bool settle(std::optional<bool> proven, Exact exact) {
        const bool checked = ++questions_ % 1009 == 0;
        by_rationals_ += !proven;
        if (proven && !checked) return *proven;
        const bool truth = exact();
        if (proven && *proven != truth) throw std::logic_error("double precision and rationals disagree");
        return truth;
    }

    /// Questions that double precision left open.
    std::uint64_t by_rationals() const { return by_rationals_; }

    Slab columns(int x0, int x1) const { return oracle.column_slab(oracle.columns(x0, x1)); }
    Slab rows(int y0, int y1) const { return oracle.row_slab(oracle.rows(y0, y1)); }

    const Oracle oracle;
    const FlatDepths range;  ///< near to far
    Filter filter;

private:
    std::uint64_t questions_ = 0, by_rationals_ = 0;
};

}  // namespace oracle
