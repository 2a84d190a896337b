// SPDX-License-Identifier: MIT
// A picture in memory, as a PNG file, and beside another one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

struct Picture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;  // the lowest row first, as OpenGL has it
};

// Throws std::runtime_error if the file cannot be written.
void write_png(const Picture& picture, const std::string& path);

struct Difference {
    std::size_t pixels = 0;  // that are not the same bytes; 0: the pictures are identical
    int x = 0, y = 0;        // the first of them, from the lower left
    int largest = 0;         // difference of a colour channel
};
Difference compare(const Picture& a, const Picture& b);
