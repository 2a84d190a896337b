// SPDX-License-Identifier: MIT
// A frame that lightbin::dump() wrote: what its lists were made of, and the lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// An array of lights: spheres, spots or boxes.
struct LightArray {
    std::string kind;
    std::optional<std::vector<double>> view_matrix;  ///< world space to view space, by columns
    bool from_eye = false;
    std::vector<std::vector<float>> lights;  ///< the numbers of each
};

struct Frame {
    std::vector<double> projection;  ///< by columns
    int width = 0, height = 0, tile_size = 0, columns = 0, rows = 0;
    bool zero_to_one = false, upper_left = false, reversed_z = false;

    bool masks = false, narrow_ids = false, depth_test = false, clusters = false, z_bins = false;
    std::vector<float> boundaries;  ///< between the slices
    float margin = 0;
    std::vector<float> min, max;  ///< Z bounds
    std::vector<LightArray> arrays;

    /// The lists or masks, and the counts of lights.
    struct Made {
        std::vector<std::uint32_t> counts, ranges, ids, order, bins, words;
        bool operator==(const Made&) const = default;
    } made;

    /// Whether the projection turns the image by 90 or 270 degrees: columns of tiles then count along its height.
    bool turned() const { return projection[0] == 0 && projection[5] == 0; }
    int tiles_x() const { return turned() ? tiles(height, rows) : tiles(width, columns); }
    int tiles_y() const { return turned() ? tiles(width, columns) : tiles(height, rows); }
    int slices() const { return clusters ? static_cast<int>(boundaries.size()) + 1 : 1; }

private:
    int tiles(int side, int count) const {
        return side == 0 ? 0 : count > 0 ? count : (side + tile_size - 1) / tile_size;
    }
};

/// Reads the text of dump(). Throws a std::exception if it is no such text.
Frame read_frame(const std::string& text);

/// Makes the frame's lists or masks again, by this library. Throws if that is refused.
Frame::Made bin_again(const Frame& frame);

/// What lists or masks say. Ids number the arrays through, also with z-bins.
struct Cells {
    std::vector<std::vector<std::uint32_t>> lights;  ///< the ids of each cell: slice by slice, row by row
    std::vector<std::uint32_t> order;                ///< with z-bins, the lights by rank
    std::vector<std::uint32_t> bins;                 ///< with z-bins, the least and greatest rank of each
};
Cells cells_of(const Frame& frame);

/// Names for messages, such as "spot 3 (id 43)" and "tile (4, 7), slice 2".
std::string name_of_light(const Frame& frame, std::size_t id);
std::string name_of_cell(const Frame& frame, std::size_t cell);

/// What exact arithmetic says of a frame.
struct Verdict {
    std::uint64_t pairs = 0;          ///< of a light and a cell that does not list it
    std::uint64_t missed = 0;         ///< of these, how many lights reach the cell
    std::uint64_t undecided = 0;      ///< spots for which no proof was found
    std::vector<std::string> misses;  ///< the first of them: the light and the cell
};
Verdict check_exactly(const Frame& frame, const Cells& cells);
