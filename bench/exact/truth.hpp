// SPDX-License-Identifier: MIT
// Whether balls meet parts of a camera's image: in double precision if that is certain, else by rational numbers.
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

/// Answers all questions about one camera. Depths and balls come in double precision, together with functions that
/// return them as rationals if those are needed.
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

    /// Whether a ball meets the wedge of space that whole columns (or rows) of tiles show, from near to far plane: the
    /// test behind a light's rectangle of tiles.
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

    /// Returns the answer of double precision, else the exact one, which now and then also checks the former.
    template <class Exact> bool settle(std::optional<bool> proven, Exact exact) {
        const bool checked = ++questions_ % 1009 == 0;
        by_rationals_ += !proven;
        if (proven && !checked) return *proven;
        const bool truth = exact();
        if (proven && *proven != truth) throw std::logic_error("double precision and rationals disagree");
        return truth;
    }

    /// Returns how many questions were decided by rational numbers.
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
