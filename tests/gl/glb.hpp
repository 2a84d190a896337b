// SPDX-License-Identifier: MIT
// Small .glb files made by hand.
#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
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
    return glb(R"({
"asset": {"version": "2.0"},
"scene": 0,
"scenes": [{"nodes": [0, 1, 2, 5]}],
"nodes": [
  {"mesh": 0, "matrix": [10,0,0,0, 0,10,0,0, 0,0,10,0, 0,0,-20,1]},
  {"translation": [0, 0, -10], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "scale": [2, 2, 2],
   "children": [3, 4]},
  {"mesh": 1, "translation": [3, 0, -12], "scale": [-1, 1, 1]},
  {"mesh": 2, "translation": [0, 1, 2]},
  {"translation": [0, 0, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}},
  {"translation": [0, 1, 5], "children": [6, 7, 8, 9, 10]},
  {"camera": 0, "name": "front"},
  {"camera": 1, "name": "flat"},
  {"translation": [-2, 2, -15], "extensions": {"KHR_lights_punctual": {"light": 1}}},
  {"translation": [3, 2, -10], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
   "extensions": {"KHR_lights_punctual": {"light": 2}}},
  {"rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
   "extensions": {"KHR_lights_punctual": {"light": 3}}}],
"cameras": [
  {"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.5}},
  {"type": "orthographic", "orthographic": {"xmag": 8, "ymag": 6, "znear": 1, "zfar": 60}}],
"meshes": [
  {"primitives": [
    {"attributes": {"POSITION": 0}, "indices": 3, "material": 0},
    {"attributes": {"POSITION": 0}, "indices": 4},
    {"attributes": {"POSITION": 1}, "mode": 5},
    {"attributes": {"POSITION": 0}, "mode": 6},
    {"attributes": {"POSITION": 0}, "mode": 0}]},
  {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 2}, "indices": 5, "material": 1}]},
  {"primitives": [{"attributes": {"POSITION": 0}, "indices": 3, "material": 1}]}],
"materials": [
  {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}},
  {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.1, 1]}, "doubleSided": true}],
"accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1,-1,0], "max": [1,1,0]},
  {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1,-1,0], "max": [1,1,0]},
  {"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"},
  {"bufferView": 1, "byteOffset": 8, "componentType": 5123, "count": 6, "type": "SCALAR"},
  {"bufferView": 1, "byteOffset": 20, "componentType": 5125, "count": 6, "type": "SCALAR"}],
"bufferViews": [
  {"buffer": 0, "byteOffset": 0, "byteLength": 144},
  {"buffer": 0, "byteOffset": 144, "byteLength": 44}],
"buffers": [{"byteLength": 188}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [
  {"type": "point", "color": [1, 0.5, 0.25], "intensity": 40, "range": 6},
  {"type": "point", "intensity": 20},
  {"type": "spot", "intensity": 50, "range": 9, "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.6}},
  {"type": "directional", "intensity": 0.1}]}}
})",
               binary);
}

// The same file with the first `from` in it replaced by `to`, padded to the same length so that its sizes
// stay right.
inline std::string with(std::string file, const std::string& from, std::string to) {
    const std::size_t place = file.find(from);
    if (place == std::string::npos || to.size() > from.size())
        throw std::logic_error("cannot put " + to + " for " + from);
    to.resize(from.size(), ' ');
    return file.replace(place, from.size(), to);
}
