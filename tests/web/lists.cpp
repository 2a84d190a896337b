// SPDX-License-Identifier: MIT
// Prints a line for each light grid that tests/web/module.mjs makes in WebAssembly too: what it is of, its entries, and
// a hash of ranges, ids, glass ranges and ids, slices and bins.
#include "stage.hpp"

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

void print_lists(Stage& stage, const std::string& scene, double seconds) {
    static constexpr const char* names[] = {"none", "interval", "box", "z_bins", "clusters"};
    for (int method = 0; method < 5; ++method) {
        FrameSettings settings;
        settings.camera = stage.scene().cameras[0];
        settings.width = 640;
        settings.height = 360;
        settings.bin.method = static_cast<DepthMethod>(method);
        settings.seconds = seconds;
        const lightbin::View view = stage.prepare(settings).view;
        const std::vector<float> min(view.tile_count(), 10), max(view.tile_count(), 60),
            glass(view.tile_count(), 100);
        const Frame& frame = stage.frame(
            view, settings, {.min = min, .max = max, .transparent_max = glass, .background_skipped = true});
        Hash lists;
        lists.add(frame.ranges);
        lists.add(frame.ids);
        lists.add(frame.glass_ranges);
        lists.add(frame.glass_ids);
        lists.add(std::span<const std::uint32_t>(frame.slices));
        lists.add(frame.bins);
        std::printf("%s %g %s %zu %08x\n", scene.c_str(), seconds, names[method], frame.ids.size(),
                    lists.value());
    }
}

}  // namespace

int main(int count, char** files) {
    Stage stage;
    for (const char* kind : {"city", "street"})
        for (const double seconds : {0.0, 2.5}) {
            stage.make(kind, 2000);
            print_lists(stage, kind, seconds);
        }
    for (int i = 1; i < count; ++i) {
        std::ifstream file(files[i], std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(file), {});
        stage.open({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, "file.glb");
        print_lists(stage, "file", 0);
    }
}
