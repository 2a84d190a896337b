// SPDX-License-Identifier: MIT
#include "picture.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

void write_png(const Picture& picture, const std::string& path) {
    stbi_flip_vertically_on_write(1);
    if (!stbi_write_png(path.c_str(), picture.width, picture.height, 3, picture.rgb.data(),
                        3 * picture.width))
        throw std::runtime_error("cannot write '" + path + "'");
}

Difference compare(const Picture& a, const Picture& b) {
    Difference difference;
    for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
        int largest = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            largest = std::max(largest, std::abs(a.rgb[k] - b.rgb[k]));
        if (largest == 0) continue;
        if (difference.pixels++ == 0) {
            const int pixel = static_cast<int>(i / 3);
            difference.x = pixel % a.width;
            difference.y = pixel / a.width;
        }
        difference.largest = std::max(difference.largest, largest);
    }
    return difference;
}
