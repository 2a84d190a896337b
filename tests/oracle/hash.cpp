// SPDX-License-Identifier: MIT
// hash [INPUTS]: a line for each of so many random inputs (20,000 if not given): its number, family and rung, a hash of
// the input and one of the light lists that the library builds of it. tests/same_bytes.sh holds the lines of two
// versions of the library against each other.
#include "engine.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <type_traits>
#include <vector>

namespace {

using namespace oracle;

/// FNV-1a, of words of 64 bits where there are as many.
class Hash {
public:
    template <class T> void add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(values.data(), values.size() * sizeof(T));
    }
    void add(const std::string& text) { add(text.data(), text.size()); }
    void add(const void* data, std::size_t size) {
        const unsigned char* const bytes = static_cast<const unsigned char*>(data);
        mix(size);
        std::size_t i = 0;
        for (; i + 8 <= size; i += 8) {
            std::uint64_t word;
            std::memcpy(&word, bytes + i, sizeof word);
            mix(word);
        }
        for (; i < size; ++i)
            mix(bytes[i]);
    }
    unsigned long long value() const { return state_ ^ state_ >> 32; }

private:
    void mix(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x100000001b3u;
        state_ ^= state_ >> 29;
    }
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

unsigned long long hash_of(const Scene& scene) {
    Hash hash;
    hash.add(&scene.camera.m, sizeof scene.camera.m);
    const int numbers[] = {scene.camera.width, scene.camera.height, scene.camera.tile, scene.skip_background};
    hash.add(numbers, sizeof numbers);
    hash.add(scene.lights);
    for (const auto* side : {&scene.min, &scene.max, &scene.depth})
        hash.add(*side);
    return hash.value();
}

Scene scene_on(const Screen& screen, Random& random, std::size_t count) {
    Scene scene{
        camera_of("", families::any_lens(aspect_of(screen), random), screen), {}, {}, {}, {}, false};
    const Aim aim(scene.camera);
    for (std::size_t i = 0; i < count; ++i)
        scene.lights.push_back(random.chance(0.8) ? spheres::field(aim, random)
                                                  : families::any_light(aim, random));
    families::set_bounds(scene, aim, random);
    return scene;
}

/// More columns of tiles than a byte counts.
Scene wide_grid(Random& random, std::size_t count) {
    const int tile = random.integer(1, 16);
    return scene_on({random.integer(230, 800) * tile, random.integer(1, 40) * tile, tile, false}, random,
                    count);
}

/// As many tiles as a screen has.
Scene usual_grid(Random& random, std::size_t count) {
    return scene_on({1920, 1080, random.chance(0.5) ? 16 : 32, random.chance(0.5)}, random, count);
}

/// More lights than 16 bits count.
Scene many_lights(Random& random, std::size_t count) {
    const int tile = random.integer(8, 64);
    return scene_on({random.integer(1, 60) * tile, random.integer(1, 40) * tile, tile, false}, random, count);
}

/// Also none, and one.
std::size_t any_number(Random& random, std::size_t most) {
    if (random.chance(0.1)) return static_cast<std::size_t>(random.integer(0, 2));
    const int few = random.chance(0.3) ? 70 : static_cast<int>(most);
    return static_cast<std::size_t>(random.integer(0, few));
}

void print_input(const Engine& engine, std::size_t number) {
    std::vector<Family> families = all_families();
    families.push_back({"wide_grid", wide_grid, 2000});
    families.push_back({"usual_grid", usual_grid, 5000});
    const Family many = {"many_lights", many_lights, 150000};
    const Family& family = number % 400 == 0 ? many : families[number % families.size()];
    Random random(seed_of(family.name) + number);
    const RungInfo& rung = all_rungs()[number / families.size() % all_rungs().size()];
    const Scene scene = family.make(random, any_number(random, family.lights));
    std::vector<std::string> complaints;
    const Lists lists = engine.lists(scene, rung.rung, complaints);
    Hash hash;
    hash.add(lists.offsets);
    hash.add(lists.ids);
    hash.add(&lists.rejected, sizeof lists.rejected);
    for (const std::string& complaint : complaints)
        hash.add(complaint);
    std::printf("%zu %s, %s, %zu lights: input %016llx lists %016llx\n", number, family.name.c_str(),
                rung.name.c_str(), scene.lights.size(), hash_of(scene), hash.value());
    for (const std::string& complaint : complaints)
        std::printf("%zu %s: %s\n", number, family.name.c_str(), complaint.c_str());
}

}  // namespace

int main(int count, char** words) {
    const long inputs = count > 1 ? std::atol(words[1]) : 20000;
    if (count > 2 || inputs < 1) {
        std::fprintf(stderr, "hash [INPUTS]: a hash of the light lists of so many random inputs\n");
        return 2;
    }
    const Engine engine;
    const bool terminal = isatty(2) != 0;
    std::time_t said = std::time(nullptr);
    for (long number = 0; number < inputs; ++number) {
        print_input(engine, static_cast<std::size_t>(number));
        const std::time_t now = std::time(nullptr);
        if (now - said < (terminal ? 1 : 20)) continue;
        said = now;
        std::fprintf(stderr, terminal ? "\r%ld of %ld inputs " : "%ld of %ld inputs\n", number + 1, inputs);
    }
    if (terminal) std::fprintf(stderr, "\r\033[K");
}
