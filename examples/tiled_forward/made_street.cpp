// SPDX-License-Identifier: MIT
#include "made_shapes.hpp"
#include "scene.hpp"

#include <cmath>

using namespace made;

namespace {

constexpr float road = 7, kerb = 11, depth = 18;          // half widths of the avenue, and of a building
constexpr float block = 64, gap = 13, last = -3 * block;  // along the avenue, which ends at a tower
constexpr glm::vec3 sodium(1, 0.62f, 0.28f), neon(0.75f, 0.87f, 1), white(1, 0.95f, 0.86f);

float radians(float degrees) {
    return glm::radians(degrees);
}

void add_spot(Scene& scene, glm::vec3 position, glm::vec3 direction, float half_degrees, float range,
              glm::vec3 candela) {
    Light light;
    light.position = position;
    light.range = range;
    light.intensity = candela;
    light.spot = true;
    light.direction = glm::normalize(direction);
    light.cos_inner = std::cos(radians(0.6f * half_degrees));
    light.cos_outer = std::cos(radians(half_degrees));
    scene.lights.push_back(light);
}

void add_point(Scene& scene, glm::vec3 position, float range, glm::vec3 candela) {
    Light light;
    light.position = position;
    light.range = range;
    light.intensity = candela;
    scene.lights.push_back(light);
}

// From corner to corner, level.
void add_paint(Scene& scene, glm::vec2 low, glm::vec2 high, float y, glm::vec3 colour) {
    add_quad(scene.triangles,
             {{{low.x, y, high.y}, {high.x, y, high.y}, {high.x, y, low.y}, {low.x, y, low.y}}}, {0, 1, 0},
             colour);
}

// A post with an arm, its lamp at the end of the arm, towards the middle of the road.
void add_lamp(Scene& scene, glm::vec3 foot, glm::vec3 arm, glm::vec3 colour) {
    const glm::vec3 iron(0.16f), thin(0.07f, 0, 0.07f), top = foot + glm::vec3(0, 6.4f, 0), head = top + arm;
    add_block(scene, foot - thin, top + thin, iron);
    add_block(scene, glm::min(top, head) - 0.05f, glm::max(top, head) + 0.05f, iron);
    add_block(scene, head - glm::vec3(0.3f, 0.02f, 0.3f), head + glm::vec3(0.3f, 0.14f, 0.3f), iron);
    add_dome(scene, head + glm::vec3(0, 0.14f, 0), 0.22f, glm::vec3(0.95f));
    add_spot(scene, head - glm::vec3(0, 0.05f, 0), glm::vec3(0, -1, 0) + 0.12f * arm, 58, 12, 70.0f * colour);
    add_point(scene, head + glm::vec3(0, 0.75f, 0), 1.2f, 0.9f * colour);  // the glass shines
}

// Two head lamps and two tail lamps, on a car of two blocks that drives to -z, or with `back` to +z.
void add_car(Scene& scene, glm::vec3 middle, bool back, glm::vec3 paint) {
    const float way = back ? 1.0f : -1.0f;
    add_block(scene, middle + glm::vec3(-0.9f, 0.3f, -2.1f), middle + glm::vec3(0.9f, 0.85f, 2.1f), paint);
    add_block(scene, middle + glm::vec3(-0.75f, 0.85f, -0.9f - 0.3f * way),
              middle + glm::vec3(0.75f, 1.4f, 1.1f - 0.3f * way), 0.4f * paint);
    for (const float side : {-0.65f, 0.65f}) {
        const glm::vec3 front = middle + glm::vec3(side, 0.65f, 2.15f * way),
                        rear = middle + glm::vec3(side, 0.7f, -2.15f * way);
        add_spot(scene, front, {0.05f * side, -0.1f, way}, 24, 30, 160.0f * neon);
        add_spot(scene, rear, {0, -0.35f, -way}, 65, 5, 5.0f * glm::vec3(1, 0.06f, 0.03f));
        add_point(scene, rear + glm::vec3(0, 0, -0.25f * way), 0.5f, 0.12f * glm::vec3(1, 0.05f, 0.02f));
    }
}

// One front on the avenue, on the side of `side`, from z0 down to z1: windows, shops below, light up the wall between.
void add_building(Scene& scene, Dice& dice, float side, float z0, float z1) {
    const float floors = std::floor(dice.between(3, 8)), height = 4.2f + 3.2f * floors, x = side * kerb;
    const glm::vec3 wall = glm::vec3(dice.between(0.42f, 0.62f)) *
                           glm::vec3(1, dice.between(0.88f, 1), dice.between(0.75f, 0.95f));
    add_block(scene, {std::min(x, x + side * depth), 0, z1}, {std::max(x, x + side * depth), height, z0},
              wall);
    const auto on_wall = [&](float low, float high, float from, float to, glm::vec3 colour) {
        const float front = x - side * 0.04f;
        add_quad(scene.triangles,
                 {{{front, low, from}, {front, low, to}, {front, high, to}, {front, high, from}}},
                 {-side, 0, 0}, colour);
    };
    const int bays = static_cast<int>((z0 - z1) / 3.6f);
    const float bay = (z0 - z1) / static_cast<float>(bays);
    const glm::vec3 colour = dice.between(0, 1) < 0.4f ? sodium : rainbow(dice.between(0, 1));
    const bool shops = dice.between(0, 1) < 0.6f;
    const float foot = shops ? 3.6f : 0.25f;
    for (int i = 0; i < bays; ++i) {
        const float from = z0 - bay * static_cast<float>(i), to = from - bay, middle = (from + to) / 2;
        for (float sill = 5; sill < height - 2; sill += 3.2f) {
            const bool lit = dice.between(0, 1) < 0.2f;
            on_wall(sill, sill + 1.9f, from - 0.9f, to + 0.9f, lit ? glm::vec3(0.8f) : glm::vec3(0.05f));
            if (lit)
                add_spot(scene, {x - side * 0.5f, sill + 2.2f, middle}, {side * 0.5f, -1, 0}, 40, 3,
                         dice.between(1.5f, 4) * white);
        }
        on_wall(0.4f, 3, from - 0.5f, to + 0.5f, glm::vec3(0.1f));
        if (i % 2 == 1)
            add_spot(scene, {x - side * 0.5f, foot, to}, {side * 0.07f, 1, 0}, 17, 1.1f * height,
                     150.0f * colour);
        if (!shops) continue;
        add_block(scene, {std::min(x, x - side * 1.1f), 3.2f, to + 0.3f},
                  {std::max(x, x - side * 1.1f), 3.35f, from - 0.3f}, rainbow(dice.between(0, 1)) * 0.5f);
        add_spot(scene, {x - side * 0.6f, 3.15f, middle}, {-side * 0.1f, -1, 0}, 50, 4.5f, 9.0f * white);
    }
}

// Both sides of a block of the avenue, and the street that crosses it behind.
void add_street_block(Scene& scene, Dice& dice, float z) {
    for (const float side : {-1.0f, 1.0f}) {
        const float split = z - dice.between(18, 34), end = z - block + gap;
        add_building(scene, dice, side, z, split);
        add_building(scene, dice, side, split, end);
        for (float at = z - 5 - (side > 0 ? 7.0f : 0.0f); at > z - block; at -= 15)
            add_lamp(scene, {side * 7.6f, 0.15f, at}, {-side * 2.3f, 0, 0}, sodium);
        add_block(scene, {std::min(side * 34, side * 90), 0, end},
                  {std::max(side * 34, side * 90), dice.between(8, 20), z}, glm::vec3(0.4f));
        // The cross street's lamps are of another colour.
        for (float x = 22; x < 90; x += 13)
            for (const float edge : {-0.6f, -gap + 0.6f})
                add_lamp(scene, {side * x, 0.1f, end + edge}, {0, 0, edge > -1 ? -2.0f : 2.0f}, neon);
        for (int stripe = 0; stripe < 7; ++stripe) {
            const float x = side * (0.5f + static_cast<float>(stripe));
            add_paint(scene, {x - 0.25f, end - 3.5f}, {x + 0.25f, end - 0.5f}, 0.02f, glm::vec3(0.7f));
        }
    }
    for (float dash = z - 2; dash > z - block + gap + 4; dash -= 6)
        add_paint(scene, {-0.08f, dash - 3}, {0.08f, dash}, 0.02f, glm::vec3(0.75f));
    for (int i = 0; i < 5; ++i) {
        const bool back = i % 2 == 0;
        const float lane = (back ? -1.0f : 1.0f) * (i % 4 < 2 ? 1.8f : 4.9f);
        const glm::vec3 paint = 0.2f + 0.5f * rainbow(dice.between(0, 1)) * dice.between(0, 1);
        add_car(scene, {lane, 0, z - dice.between(3, block - 4)}, back, paint);
    }
}

// What the avenue ends at: a tower that beams of all colours play on.
void add_tower(Scene& scene, Dice& dice) {
    const glm::vec3 stone(0.7f);
    add_block(scene, {-17, 0, last - 40}, {17, 30, last - 12}, stone);
    add_block(scene, {-11, 30, last - 36}, {11, 52, last - 14}, stone);
    add_block(scene, {-5, 52, last - 30}, {5, 74, last - 18}, stone);
    for (int i = 0; i < 30; ++i) {
        const glm::vec3 from(dice.between(-16, 16), 0.4f, last + dice.between(0, 12));
        const glm::vec3 to(dice.between(-13, 13), dice.between(12, 66), last - 13);
        add_spot(scene, from, to - from, dice.between(4, 8), 110, 1300.0f * rainbow(dice.between(0, 1)));
    }
}

// A shelter at a stop: panes, and two lamps under its roof.
void add_shelter(Scene& scene, float side, float z) {
    const glm::vec3 glass(0.6f, 0.8f, 1);
    const float back = side * 10.2f, front = side * 8.7f;
    add_pane(scene, {back, 0.15f, z}, {back, 0.15f, z - 5}, 2.3f, glass);
    add_pane(scene, {back, 0.15f, z - 5}, {front, 0.15f, z - 5}, 2.3f, glass);
    add_block(scene, {std::min(back, front), 2.45f, z - 5}, {std::max(back, front), 2.55f, z},
              glm::vec3(0.3f));
    for (const float at : {1.2f, 3.8f})
        add_spot(scene, {(back + front) / 2, 2.4f, z - at}, {0, -1, 0}, 55, 3.5f, 6.0f * neon);
}

}  // namespace

Scene make_street() {
    Dice dice;
    Scene scene;
    scene.name = "made street";
    add_paint(scene, {-120, last - 60}, {120, 60}, 0, glm::vec3(0.14f));
    for (int i = -1; i < 3; ++i) {
        const float z = -block * static_cast<float>(i);
        for (const float side : {-1.0f, 1.0f})  // the pavement, and its kerb
            add_block(scene, {std::min(side * road, side * kerb), 0, z - block + gap},
                      {std::max(side * road, side * kerb), 0.15f, z}, glm::vec3(0.4f));
        add_street_block(scene, dice, z);
    }
    add_tower(scene, dice);
    for (int i = 0; i < 4; ++i)
        add_shelter(scene, i % 2 == 0 ? 1.0f : -1.0f, -14.0f - 55 * static_cast<float>(i));
    scene.cameras = {look("over the street", {4.5, 9.5, 9}, {-1.5, 5.0, -60}, 50),
                     look("on the pavement", {8.6, 1.75, -3}, {2, 3.2, -60}, 55),
                     look("from above", {14, 95, 5}, {0, 0, -62}, 60)};
    return scene;
}
