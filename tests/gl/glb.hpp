// SPDX-License-Identifier: MIT
// Small .glb files made by hand.
#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

// The bytes of a binary glTF file: its JSON and its one buffer, `binary`.
inline std::string glb(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t value) {
        std::string bytes;
        for (int shift = 0; shift < 32; shift += 8)
            bytes += static_cast<char>(value >> shift & 0xff);
        return bytes;
    };
    const std::size_t size = 12 + 8 + json.size() + 8 + binary.size();
    return "glTF" + word(2) + word(size) + word(json.size()) + "JSON" + json + word(binary.size()) +
           std::string("BIN\0", 4) + binary;
}

template <class T> std::string bytes_of(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline void write_file(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// Everything a loader can meet in one scene: nested nodes (matrix and TRS, one mirrored), a mesh of several
// primitives without normals and one with, indices of 8, 16 and 32 bits and none, a strip and a fan, two base
// colours, lights with and without a range, a spot light, a directional one, a perspective and an
// orthographic camera.
inline std::string everything_glb() {
    const std::vector<float> square = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};  // faces +z
    const std::vector<float> strip = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    const std::vector<float> normals = {0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f};
    const std::string binary = bytes_of(square) +                                             // at 0
                               bytes_of(strip) +                                              // at 48
                               bytes_of(normals) +                                            // at 96
                               bytes_of(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3, 0, 0}) +  // at 144
                               bytes_of(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}) +       // at 152
                               bytes_of(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});        // at 164
    std::ifstream json(LIGHTBIN_FIXTURES "/everything.json");
    return glb({std::istreambuf_iterator<char>(json), {}}, binary);
}

// Returns a file with the first `from` in it replaced by `to`, padded to the same length so that its sizes
// stay right.
inline std::string with(std::string file, const std::string& from, std::string to) {
    const std::size_t place = file.find(from);
    if (place == std::string::npos || to.size() > from.size())
        throw std::logic_error("cannot put " + to + " for " + from);
    to.resize(from.size(), ' ');
    return file.replace(place, from.size(), to);
}
