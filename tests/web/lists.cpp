// SPDX-License-Identifier: MIT
// Prints a line for each light grid that tests/web/lists.mjs makes with the page's lighting.js too: what it is of, its entries, and
// a hash of ranges, ids, glass ranges and ids, slices, bins and the lights' spheres.
#include "native_lists.hpp"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace {

// FNV-1a, a word at a time.
class Hash {
public:
    template <class T> void add(std::span<const T> items) {
        for (const std::byte *at = std::as_bytes(items).data(), *end = at + items.size_bytes(); at != end;
             at += 4) {
            std::uint32_t word;
            std::memcpy(&word, at, 4);
            hash_ = (hash_ ^ word) * 16777619;
        }
    }
    std::uint32_t value() const { return hash_; }

private:
    std::uint32_t hash_ = 2166136261;
};

void print_lists(Scene scene, const std::string& name, double seconds) {
    static constexpr const char* names[] = {"none", "z_bounds", "z_bins", "clusters"};
    scene.boxes.clear();  // the page has none
    NativeLists native(scene);
    for (int method = 0; method < 4; ++method) {
        FrameSettings settings;
        settings.camera = scene.cameras[0];
        settings.width = 640;
        settings.height = 360;
        settings.bin.method = static_cast<DepthMethod>(method);
        settings.seconds = seconds;
        const lightbin::View view = view_of(settings);
        const std::vector<float> min(view.tile_count(), 10), max(view.tile_count(), 60),
            glass(view.tile_count(), 100);
        const Frame frame = native.frame(view, settings, {.min = min, .max = max}, {.max = glass});
        Hash lists;
        lists.add(frame.ranges);
        lists.add(frame.ids);
        lists.add(frame.glass_ranges);
        lists.add(frame.glass_ids);
        lists.add(std::span<const std::uint32_t>(frame.slices));
        lists.add(frame.bins);
        for (const GpuLight& light : frame.lights)  // colours are rounded otherwise in WebAssembly
            lists.add(std::span(&light.sphere.x, 4));
        std::printf("%s %g %s %zu %08x\n", name.c_str(), seconds, names[method], frame.ids.size(),
                    lists.value());
    }
}

}  // namespace

int main(int count, char** files) {
    for (const double seconds : {0.0, 2.5})
        print_lists(make_scene(2000), "city", seconds);
    for (const double seconds : {0.0, 2.5})
        print_lists(make_street(), "street", seconds);
    for (int i = 1; i < count; ++i) {
        std::ifstream file(files[i], std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(file), {});
        print_lists(
            read_glb({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, "file.glb", 0.05f),
            "file", 0);
    }
}
