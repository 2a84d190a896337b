// SPDX-License-Identifier: MIT
// Replays a frame that lightbin::dump() wrote: makes its lists again, checks them exactly, names what costs most, and
// draws how many lights each tile has.
#include "frame.hpp"

#include <CLI/CLI.hpp>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>

namespace {

/// Prints the greatest of some counts, each with a name.
void print_most(const char* what, const char* unit, const std::vector<std::size_t>& counts,
                const std::function<std::string(std::size_t)>& name) {
    std::vector<std::size_t> places(counts.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(5, places.size()));
    std::partial_sort(places.begin(), end, places.end(),
                      [&](std::size_t a, std::size_t b) { return counts[a] > counts[b]; });
    for (auto place = places.begin(); place != end; ++place)
        std::printf("%-12s %6zu %s  %s\n", place == places.begin() ? what : "", counts[*place], unit,
                    name(*place).c_str());
}

/// Writes a picture of the tiles: black for no light, then from blue to red, and white for the most of all. With
/// clusters a tile counts the lights of its fullest slice.
void draw(const Frame& frame, const Cells& cells, const std::string& file) {
    const auto nx = static_cast<std::size_t>(frame.tiles_x()), ny = static_cast<std::size_t>(frame.tiles_y());
    if (nx * ny == 0) return;
    std::vector<std::size_t> counts(nx * ny);
    for (std::size_t cell = 0; cell < cells.lights.size(); ++cell)
        counts[cell % counts.size()] = std::max(counts[cell % counts.size()], cells.lights[cell].size());
    const std::size_t most = *std::max_element(counts.begin(), counts.end());
    const std::size_t side = std::max<std::size_t>(1, 1280 / std::max(nx, ny)), width = nx * side,
                      height = ny * side;
    // In the picture x of view space grows to the right, y upward: as columns and rows of tiles do with these signs.
    const double up = frame.upper_left ? -1 : 1;
    const bool rightward = (frame.turned() ? up * frame.projection[1] : frame.projection[0]) > 0,
               upward = (frame.turned() ? frame.projection[4] : up * frame.projection[5]) > 0;
    std::vector<unsigned char> rgb;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t row = upward ? ny - 1 - y / side : y / side,
                              column = rightward ? x / side : nx - 1 - x / side,
                              count = counts[row * nx + column];
            const double part = most > 0 ? static_cast<double>(count) / static_cast<double>(most) : 0;
            const auto band = [&](double middle) {
                const double ramp = std::clamp(1.5 - std::abs(4 * part - middle), 0.0, 1.0);
                return static_cast<unsigned char>(std::lround(255 * (count == most ? 1 : ramp)));
            };
            const bool edge = side > 4 && (x % side == 0 || y % side == 0);
            for (const double middle : {3.0, 2.0, 1.0})
                rgb.push_back(count == 0 || edge ? 0 : band(middle));
        }
    if (stbi_write_png(file.c_str(), static_cast<int>(width), static_cast<int>(height), 3, rgb.data(), 0) ==
        0)
        throw std::runtime_error("cannot write " + file);
    std::printf("picture      %s: black is no light, blue few, red many, white %zu%s\n", file.c_str(), most,
                frame.clusters ? ", in the fullest slice of a tile" : "");
}

/// Returns whether all is right.
bool replay(const std::string& file, const std::string& picture) {
    std::ifstream stream(file);
    if (!stream) throw std::runtime_error("cannot be read");
    const Frame frame = read_frame({std::istreambuf_iterator<char>(stream), {}});
    const Cells cells = cells_of(frame);
    std::vector<std::size_t> cells_of_light(frame.made.counts[0]), lights_of_cell;
    for (const std::vector<std::uint32_t>& lights : cells.lights) {
        lights_of_cell.push_back(lights.size());
        for (const std::uint32_t id : lights)
            ++cells_of_light.at(id);
    }
    std::printf("frame        %d x %d pixels in %d x %d tiles%s; %u lights, of which %u are out of view or off and "
                "%u rejected\n",
                frame.width, frame.height, frame.tiles_x(), frame.tiles_y(),
                frame.clusters ? (" and " + std::to_string(frame.slices()) + " slices").c_str() : "",
                frame.made.counts[0], frame.made.counts[2], frame.made.counts[1]);
    print_most("costly lights", "cells ", cells_of_light,
               [&](std::size_t id) { return name_of_light(frame, id); });
    print_most("costly cells", "lights", lights_of_cell,
               [&](std::size_t cell) { return name_of_cell(frame, cell); });
    draw(frame, cells, picture);

    bool right = true;
    try {
        const Frame::Made again = bin_again(frame);
        right = again == frame.made;
        std::printf("made again   %s\n",
                    right ? "the same" : "DIFFERENT: this library makes other lists of this frame");
    } catch (const std::exception& error) {
        std::printf("made again   not: %s\n", error.what());
    }
    const Verdict verdict = check_exactly(frame, cells);
    std::printf("exact check  %llu of %llu missed: pairs of a light and a cell that does not list it%s\n",
                static_cast<unsigned long long>(verdict.missed),
                static_cast<unsigned long long>(verdict.pairs),
                cells.lights.empty() ? "; the viewport has no pixels" : "");
    if (verdict.undecided > 0)
        std::printf("             %llu pairs could not be decided\n",
                    static_cast<unsigned long long>(verdict.undecided));
    for (const std::string& miss : verdict.misses)
        std::printf("             MISSED: %s\n", miss.c_str());
    return right && verdict.missed == 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Replays a frame that lightbin::dump() wrote");
    std::string file, picture = "replay.png";
    app.add_option("file", file, "The frame")->required();
    app.add_option("-o,--output", picture, "The PNG file to write")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        return replay(file, picture) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "replay: %s: %s\n", file.c_str(), error.what());
        return 2;
    }
}
