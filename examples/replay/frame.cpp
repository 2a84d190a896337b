// SPDX-License-Identifier: MIT
// Reads what dump() wrote, and decodes the lists.
#include "frame.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <stdexcept>

namespace {

using nlohmann::json;

double number_of(const json& value) {
    if (!value.is_string()) return value.get<double>();
    return std::strtod(value.get<std::string>().c_str(), nullptr);  // NaN, Infinity or -Infinity
}

template <class Number> std::vector<Number> numbers_of(const json& array) {
    std::vector<Number> numbers;
    for (const json& value : array)
        numbers.push_back(static_cast<Number>(number_of(value)));
    return numbers;
}

}  // namespace

Frame read_frame(const std::string& text) {
    const json all = json::parse(text);
    Frame frame;
    frame.projection = numbers_of<double>(all.at("projection"));
    frame.width = all.at("width");
    frame.height = all.at("height");
    frame.tile_size = all.at("tile_size");
    frame.columns = all.at("columns");
    frame.rows = all.at("rows");
    frame.zero_to_one = all.at("clip_depth") == "zero_to_one";
    frame.upper_left = all.at("origin") == "upper_left";
    frame.reversed_z = all.at("reversed_z");
    frame.masks = all.contains("words");
    frame.narrow_ids = all.at("id_width") == "u16";
    frame.depth_test = all.at("depth_test");
    frame.clusters = all.at("slicing") == "clusters";
    frame.z_bins = all.at("slicing") == "z_bins";
    if (all.contains("boundaries")) {
        frame.boundaries = numbers_of<float>(all["boundaries"]);
        frame.margin = all.at("margin");
    }
    frame.min = numbers_of<float>(all.at("min_depths"));
    frame.max = numbers_of<float>(all.at("max_depths"));
    for (const json& given : all.at("arrays")) {
        LightArray& array = frame.arrays.emplace_back();
        array.kind = given.at("kind");
        if (given.contains("view_matrix")) array.view_matrix = numbers_of<double>(given["view_matrix"]);
        array.from_eye = given.value("from_eye", false);
        const std::size_t size = array.kind == "spheres" ? 4 : array.kind == "spots" ? 8 : 17;
        for (const json& light : given.at("lights"))
            if (array.lights.emplace_back(numbers_of<float>(light)).size() != size)
                throw std::runtime_error("one of the " + array.kind + " has not " + std::to_string(size) +
                                         " numbers");
    }
    frame.made.counts = {all.at("lights"), all.at("rejected"), all.at("culled")};
    const auto read = [&](const char* name, std::vector<std::uint32_t>& to) {
        if (all.contains(name)) to = numbers_of<std::uint32_t>(all[name]);
    };
    read("ranges", frame.made.ranges);
    read("ids", frame.made.ids);
    read("order", frame.made.order);
    read("bins", frame.made.bins);
    read("words", frame.made.words);
    return frame;
}

Cells cells_of(const Frame& frame) {
    const Frame::Made& made = frame.made;
    const std::size_t columns = static_cast<std::size_t>(frame.tiles_x()),
                      rows = static_cast<std::size_t>(frame.tiles_y());
    Cells cells = {{}, made.order, made.bins};
    for (std::size_t i = 0; i < made.ranges.size(); i += 2) {
        std::vector<std::uint32_t>& lights = cells.lights.emplace_back();
        for (std::size_t entry = 0; entry < made.ranges.at(i + 1); ++entry) {
            const std::uint32_t id = made.ids.at(made.ranges[i] + entry);
            lights.push_back(frame.z_bins ? made.order.at(id) : id);
        }
    }
    if (frame.masks) {
        // As LightMasks::words() describes it.
        const std::vector<std::uint32_t>& words = made.words;
        const std::size_t each = words.at(0), visible = made.counts[0] - made.counts[1] - made.counts[2];
        const auto mask = [&](std::size_t number, std::size_t word) {
            return words.at(1 + number * each + word);
        };
        for (std::size_t place = 0; place < visible; ++place)
            cells.order.push_back(mask(columns + 1 + rows, place));
        for (std::size_t y = 0; y < rows; ++y)
            for (std::size_t x = 0; x < columns; ++x) {
                std::vector<std::uint32_t>& lights = cells.lights.emplace_back();
                for (std::size_t place = 0; place < visible; ++place)
                    if ((mask(x, place / 32) & mask(columns + 1 + y, place / 32)) >> place % 32 & 1)
                        lights.push_back(cells.order[place]);
            }
        if (frame.z_bins)
            cells.bins.assign(words.end() - 2 * static_cast<std::ptrdiff_t>(frame.boundaries.size() + 1),
                              words.end());
    }
    if (cells.lights.size() != columns * rows * static_cast<std::size_t>(frame.slices()))
        throw std::runtime_error("it has lists of " + std::to_string(cells.lights.size()) +
                                 " cells, and the view " + std::to_string(columns) + " x " +
                                 std::to_string(rows) + " tiles");
    return cells;
}

std::string name_of_light(const Frame& frame, std::size_t id) {
    std::size_t at = id;
    for (const LightArray& array : frame.arrays) {
        if (at < array.lights.size())
            return (array.kind == "boxes"   ? "box"
                    : array.kind == "spots" ? "spot"
                                            : "sphere") +
                   (' ' + std::to_string(at)) + (at == id ? "" : " (id " + std::to_string(id) + ")");
        at -= array.lights.size();
    }
    throw std::runtime_error("a list has the id " + std::to_string(id) + ", and there is no such light");
}

std::string name_of_cell(const Frame& frame, std::size_t cell) {
    const std::size_t columns = static_cast<std::size_t>(frame.tiles_x()),
                      rows = static_cast<std::size_t>(frame.tiles_y());
    const std::size_t slice = cell / (columns * rows);
    return "tile (" + std::to_string(cell % columns) + ", " + std::to_string(cell / columns % rows) + ")" +
           (frame.clusters ? ", slice " + std::to_string(slice) : "");
}
