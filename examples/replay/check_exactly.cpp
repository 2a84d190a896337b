// SPDX-License-Identifier: MIT
// Whether a light reaches a cell that does not list it, by exact rational arithmetic: the tests' own reference.
#include "frame.hpp"

#include "../../bench/exact/box.hpp"
#include "../../bench/exact/spot.hpp"

#include <cmath>
#include <variant>

namespace {

using namespace oracle;

/// Returns the frame's camera; of a turned image, that of the upright one, with the same columns and rows of tiles.
Camera camera_of(const Frame& frame) {
    Camera camera;
    camera.width = frame.width, camera.height = frame.height, camera.tile = frame.tile_size;
    camera.columns = frame.columns, camera.rows = frame.rows;
    camera.zero_to_one = frame.zero_to_one, camera.upper_left = frame.upper_left,
    camera.reversed = frame.reversed_z;
    for (int i = 0; i < 16; ++i)
        camera.m[i / 4][i % 4] = frame.projection[static_cast<std::size_t>(i)];
    if (!frame.turned()) return camera;
    std::swap(camera.width, camera.height);
    std::swap(camera.columns, camera.rows);
    const int up = frame.upper_left ? -1 : 1;
    for (int column = 0; column < 4; ++column) {
        const double x = camera.m[column][0];
        camera.m[column][0] = up * camera.m[column][1];
        camera.m[column][1] = up * x;
    }
    return camera;
}

/// From an array's space to view space.
struct ToView {
    Vector column[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    double stretch = 1;  ///< no length is stretched more

    explicit ToView(const LightArray& array) {
        if (!array.view_matrix) return;
        const std::vector<double>& m = *array.view_matrix;
        for (std::size_t i = 0; i < 4; ++i)
            column[i] = {exact(m[4 * i]), exact(m[4 * i + 1]), exact(m[4 * i + 2])};
        // The square of the greatest stretch is an eigenvalue of the transpose times the matrix: at most the greatest
        // sum of a row's sizes (Gershgorin).
        Rational most = 0;
        for (int i = 0; i < 3; ++i)
            most = std::max(most, Rational(abs(dot(column[i], column[0])) + abs(dot(column[i], column[1])) +
                                           abs(dot(column[i], column[2]))));
        stretch = std::sqrt(nearly(most)) * (1 + 0x1p-30);
    }
    Vector operator()(const Vector& p) const {
        return p.x * column[0] + p.y * column[1] + p.z * column[2] + column[3];
    }
    HalfSpace preimage(const HalfSpace& h) const {
        return {{dot(h.a, column[0]), dot(h.a, column[1]), dot(h.a, column[2])}, dot(h.a, column[3]) + h.b};
    }
};

/// Whether no list may have a light: it is bad input or switched off.
bool is_unlit(const std::string& kind, const std::vector<float>& light) {
    for (std::size_t i = 0; i < light.size(); ++i)
        if (!std::isfinite(light[i]) && i != 3 && !(kind == "spots" && i > 3 && light[7] == -1)) return true;
    const auto none = [&](std::size_t begin, std::size_t end) {
        return std::all_of(light.begin() + static_cast<std::ptrdiff_t>(begin),
                           light.begin() + static_cast<std::ptrdiff_t>(end), [](float v) { return v == 0; });
    };
    if (!(light[3] >= 0)) return true;
    if (kind == "spots") return !(std::abs(light[7]) <= 1) || (light[7] != -1 && none(4, 7));
    return kind == "boxes" && (!(light[16] >= 0) || !(light[16] <= 1) || none(7, 16));
}

using Shape = std::variant<Ball, ExactSpot, ExactBox>;
Shape shape_of(const std::string& kind, const std::vector<float>& v) {
    if (kind == "spheres" || (kind == "spots" && v[7] == -1)) return exact_ball(v[0], v[1], v[2], v[3]);
    if (kind == "spots") return exact_spot(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]);
    return ExactBox({v[0],
                     v[1],
                     v[2],
                     v[3],
                     {v[4], v[5], v[6]},
                     {{v[7], v[8], v[9]}, {v[10], v[11], v[12]}, {v[13], v[14], v[15]}},
                     v[16]});
}

class Check {
public:
    Check(const Frame& frame, const Cells& cells)
        : frame_(frame), cells_(cells), oracle_(camera_of(frame)), filter_(oracle_) {}

    Verdict verdict() {
        std::vector<std::vector<std::size_t>> cells_of_light;
        for (const LightArray& array : frame_.arrays)
            cells_of_light.resize(cells_of_light.size() + array.lights.size());
        for (std::size_t cell = 0; cell < cells_.lights.size(); ++cell)
            for (const std::uint32_t id : cells_.lights[cell])
                cells_of_light.at(id).push_back(cell);
        std::vector<std::size_t> ranks(cells_of_light.size(), ~std::size_t{0});
        for (std::size_t rank = 0; rank < cells_.order.size(); ++rank)
            ranks.at(cells_.order[rank]) = rank;
        for (const LightArray& array : frame_.arrays) {
            const ToView to_view(array);
            for (const std::vector<float>& light : array.lights) {
                if (!is_unlit(array.kind, light)) {
                    const Shape shape = shape_of(array.kind, light);
                    const CameraBall seen =
                        oracle_.in_camera({to_view(exact_ball(light[0], light[1], light[2], 0).centre), 0});
                    const double x = nearly(seen.x), y = nearly(seen.y), depth = nearly(seen.depth);
                    // The ball around the light's image, and what rounding to double moves the centre by.
                    ball_ = {x, y, depth,
                             static_cast<double>(light[3]) * to_view.stretch +
                                 0x1p-50 * (std::abs(x) + std::abs(y) + std::abs(depth))};
                    to_view_ = &to_view, shape_ = &shape;
                    check_light(cells_of_light[id_], ranks[id_]);
                }
                ++id_;
            }
        }
        return verdict_;
    }

private:
    void check_light(const std::vector<std::size_t>& listed, std::size_t rank) {
        lists_.assign(cells_.lights.size(), false);
        for (const std::size_t cell : listed)
            lists_[cell] = true;
        verdict_.pairs += lists_.size() - listed.size();
        const int nx = frame_.tiles_x(), ny = frame_.tiles_y();
        for (int slice = 0; slice < frame_.slices(); ++slice)
            check_tiles(slice, 0, nx, 0, ny);
        for (std::size_t bin = 0; rank < cells_.order.size() && bin < cells_.bins.size() / 2; ++bin) {
            if (rank >= cells_.bins[2 * bin] && rank <= cells_.bins[2 * bin + 1]) continue;
            ++verdict_.pairs;
            if (reaches(0, nx, 0, ny, depths(bin, {}), true)) miss("z-bin " + std::to_string(bin));
        }
    }

    /// Proves that the light does not reach those of the tiles [x0, x1) x [y0, y1) that lack it.
    void check_tiles(int slice, int x0, int x1, int y0, int y1) {
        const bool single = x1 - x0 == 1 && y1 - y0 == 1;
        const auto cell = [&](int x, int y) {
            return static_cast<std::size_t>((slice * frame_.tiles_y() + y) * frame_.tiles_x() + x);
        };
        const std::size_t tile = static_cast<std::size_t>(y0 * frame_.tiles_x() + x0);
        int lacking = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
                lacking += !lists_[cell(x, y)];
        const bool all_lack = lacking == (x1 - x0) * (y1 - y0);
        if (lacking == 0 ||
            !reaches(x0, x1, y0, y1,
                     depths(frame_.clusters ? std::optional(static_cast<std::size_t>(slice)) : std::nullopt,
                            single ? std::optional(tile) : std::nullopt),
                     all_lack))
            return;
        if (single)
            miss(name_of_cell(frame_, cell(x0, y0)));
        else if (x1 - x0 > y1 - y0)
            check_tiles(slice, x0, (x0 + x1) / 2, y0, y1), check_tiles(slice, (x0 + x1) / 2, x1, y0, y1);
        else
            check_tiles(slice, x0, x1, y0, (y0 + y1) / 2), check_tiles(slice, x0, x1, (y0 + y1) / 2, y1);
    }

    /// The depths of a slice, or of a tile's Z bounds, or both.
    Depths depths(std::optional<std::size_t> slice, std::optional<std::size_t> tile) const {
        float low = -INFINITY, high = INFINITY;
        if (slice && *slice > 0) low = frame_.boundaries.at(*slice - 1);
        if (slice && *slice < frame_.boundaries.size()) high = frame_.boundaries[*slice];
        if (tile && !frame_.min.empty()) low = std::fmax(low, frame_.min.at(*tile));  // a NaN is no bound
        if (tile && !frame_.max.empty()) high = std::fmin(high, frame_.max.at(*tile));
        return oracle_.depths(low, high);
    }

    /// Returns false if the light does not reach the tiles between these depths.
    ///
    /// surely  whether true is certain, too; else it may mean that it is not known
    bool reaches(int x0, int x1, int y0, int y1, const Depths& depths, bool surely) {
        if (depths.contains_none() || filter_.apart(x0, x1, y0, y1, FlatDepths(depths), ball_)) return false;
        if (!surely) return true;
        std::vector<HalfSpace> cell =
            oracle_.half_spaces(oracle_.columns(x0, x1), oracle_.rows(y0, y1), depths);
        for (HalfSpace& side : cell)
            side = to_view_->preimage(side);
        const std::optional<bool> met =
            std::visit([&](const auto& shape) { return std::optional<bool>(meets(cell, shape)); }, *shape_);
        undecided_ = !met;
        return !met || *met;
    }

    void miss(const std::string& cell) {
        if (undecided_) {
            ++verdict_.undecided;
            return;
        }
        if (verdict_.missed++ < 10) verdict_.misses.push_back(name_of_light(frame_, id_) + ", in " + cell);
    }

    const Frame& frame_;
    const Cells& cells_;
    Oracle oracle_;
    Filter filter_;
    Verdict verdict_;
    // Of the light that is checked:
    std::size_t id_ = 0;
    FlatBall ball_ = {};
    const ToView* to_view_ = nullptr;
    const Shape* shape_ = nullptr;
    std::vector<bool> lists_;  ///< by cell
    bool undecided_ = false;
};

}  // namespace

Verdict check_exactly(const Frame& frame, const Cells& cells) {
    if (cells.lights.empty()) return {};
    return Check(frame, cells).verdict();
}
