// SPDX-License-Identifier: MIT
#include "made_shapes.hpp"
#include "scene.hpp"

#include <cmath>

using namespace made;

namespace {

constexpr float road = 7, kerb = 11, depth = 18;          // half widths of the avenue, and of a building
constexpr float block = 64, gap = 13, last = -3 * block;  // along the avenue, which ends at a tower
constexpr glm::vec3 sodium(1, 0.62f, 0.28f), neon(0.75f, 0.87f, 1), white(1, 0.95f, 0.86f);

void add_spot(Scene& scene, glm::vec3 position, glm::vec3 direction, float half_degrees, float range,
              glm::vec3 candela) {
    Light light;
    light.position = position;
    light.range = range;
    light.intensity = candela;
    light.spot = true;
    light.direction = glm::normalize(direction);
    light.cos_inner = std::cos(glm::radians(0.6f * half_degrees));
    light.cos_outer = std::cos(glm::radians(half_degrees));
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

// Whatever lies between two corners, given in any order.
void add_box(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 colour) {
    add_block(scene, glm::min(a, b), glm::max(a, b), colour);
}

// A wall on the avenue, and a part of it from one window's axis to the next.
struct Front {
    float side, x, height;
};
struct Bay {
    float from, to;
    float middle() const { return (from + to) / 2; }
};

void add_on_wall(Scene& scene, const Front& front, float low, float high, const Bay& bay, glm::vec3 colour) {
    const float x = front.x - front.side * 0.04f;
    add_quad(scene.triangles,
             {{{x, low, bay.from}, {x, low, bay.to}, {x, high, bay.to}, {x, high, bay.from}}},
             {-front.side, 0, 0}, colour);
}

// Some have a lamp above them.
void add_windows(Scene& scene, Dice& dice, const Front& front, const Bay& bay) {
    for (float sill = 5; sill < front.height - 2; sill += 3.2f) {
        const bool lit = dice.between(0, 1) < 0.2f;
        add_on_wall(scene, front, sill, sill + 1.9f, {bay.from - 0.9f, bay.to + 0.9f},
                    lit ? glm::vec3(0.8f) : glm::vec3(0.05f));
        if (lit)
            add_spot(scene, {front.x - front.side * 0.5f, sill + 2.2f, bay.middle()},
                     {front.side * 0.5f, -1, 0}, 40, 3, dice.between(1.5f, 4) * white);
    }
}

// An awning, and a lamp under it.
void add_shop(Scene& scene, Dice& dice, const Front& front, const Bay& bay) {
    const float x = front.x, side = front.side;
    add_box(scene, {x, 3.2f, bay.to + 0.3f}, {x - side * 1.1f, 3.35f, bay.from - 0.3f},
            0.5f * rainbow(dice.between(0, 1)));
    add_spot(scene, {x - side * 0.6f, 3.15f, bay.middle()}, {-side * 0.1f, -1, 0}, 50, 4.5f, 9.0f * white);
}

// One house from `start` down to `end`: windows, shops below, and light up the wall between them.
void add_building(Scene& scene, Dice& dice, float side, float start, float end) {
    const Front front{side, side * kerb, 4.2f + 3.2f * std::floor(dice.between(3, 8))};
    const float grey = dice.between(0.42f, 0.62f);
    const glm::vec3 tint{1, dice.between(0.88f, 1), dice.between(0.75f, 0.95f)};
    add_box(scene, {front.x, 0, start}, {front.x + side * depth, front.height, end}, grey * tint);

    const bool plain = dice.between(0, 1) < 0.4f, shops = dice.between(0, 1) < 0.6f;
    const glm::vec3 colour = plain ? sodium : rainbow(dice.between(0, 1));
    const int bays = static_cast<int>((start - end) / 3.6f);
    const float width = (start - end) / static_cast<float>(bays);
    for (int i = 0; i < bays; ++i) {
        const float from = start - width * static_cast<float>(i);
        const Bay bay{from, from - width};
        add_windows(scene, dice, front, bay);
        add_on_wall(scene, front, 0.4f, 3, {bay.from - 0.5f, bay.to + 0.5f}, glm::vec3(0.1f));
        if (shops) add_shop(scene, dice, front, bay);
        if (i % 2 == 1)
            add_spot(scene, {front.x - side * 0.5f, shops ? 3.6f : 0.25f, bay.to}, {side * 0.07f, 1, 0}, 17,
                     1.1f * front.height, 150.0f * colour);
    }
}

// Lamps on both sides, and behind the houses of the avenue more of them.
void add_cross_street(Scene& scene, Dice& dice, float side, float start, float end) {
    add_box(scene, {side * 34, 0, end}, {side * 90, dice.between(8, 20), start}, glm::vec3(0.4f));
    for (float x = 22; x < 90; x += 13) {
        add_lamp(scene, {side * x, 0.1f, end - 0.6f}, {0, 0, -2}, neon);
        add_lamp(scene, {side * x, 0.1f, end - gap + 0.6f}, {0, 0, 2}, neon);
    }
    for (int stripe = 0; stripe < 7; ++stripe) {
        const float x = side * (0.5f + static_cast<float>(stripe));
        add_paint(scene, {x - 0.25f, end - 3.5f}, {x + 0.25f, end - 0.5f}, 0.02f, glm::vec3(0.7f));
    }
}

// Both sides of a block of the avenue, and the street that crosses it behind.
void add_street_block(Scene& scene, Dice& dice, float start) {
    const float end = start - block + gap;
    for (const float side : {-1.0f, 1.0f}) {
        add_box(scene, {side * road, 0, end}, {side * kerb, 0.15f, start}, glm::vec3(0.4f));  // the pavement
        const float split = start - dice.between(18, 34);
        add_building(scene, dice, side, start, split);
        add_building(scene, dice, side, split, end);
        // From the walls down to the road.
        for (float at = start - (side > 0 ? 8.0f : 17.0f); at > end; at -= 17)
            add_projector(scene, {side * (kerb - 0.6f), 7, at}, {-side * 10, -9, 0}, 4, 3,
                          450.0f * (0.15f + 0.85f * rainbow(0.03f * at)));
        for (float at = start - (side > 0 ? 12.0f : 5.0f); at > start - block; at -= 15)
            add_lamp(scene, {side * 7.6f, 0.15f, at}, {-side * 2.3f, 0, 0}, sodium);
        add_cross_street(scene, dice, side, start, end);
    }
    for (float dash = start - 2; dash > end + 4; dash -= 6)
        add_paint(scene, {-0.08f, dash - 3}, {0.08f, dash}, 0.02f, glm::vec3(0.75f));
    for (int i = 0; i < 5; ++i) {
        const bool back = i % 2 == 0;
        const float lane = (back ? -1.0f : 1.0f) * (i % 4 < 2 ? 1.8f : 4.9f);
        const float hue = dice.between(0, 1), strength = dice.between(0.1f, 0.5f);
        add_car(scene, {lane, 0, start - dice.between(3, block - 4)}, back, 0.2f + strength * rainbow(hue));
    }
}

// What the avenue ends at: a tower that beams of all colours play on.
void add_tower(Scene& scene, Dice& dice) {
    const glm::vec3 stone(0.7f);
    add_block(scene, {-17, 0, last - 40}, {17, 30, last - 12}, stone);
    add_block(scene, {-11, 30, last - 36}, {11, 52, last - 14}, stone);
    add_block(scene, {-5, 52, last - 30}, {5, 74, last - 18}, stone);
    for (const float side : {-1.0f, 1.0f})
        add_projector(scene, {side * 5, 12, last + 30}, {side * 4, 12, -56}, 9, 8, 2500.0f * white);
    for (int i = 0; i < 30; ++i) {
        const glm::vec3 from{dice.between(-16, 16), 0.4f, last + dice.between(0, 12)};
        const glm::vec3 to{dice.between(-13, 13), dice.between(12, 66), last - 13};
        const float half_degrees = dice.between(4, 8);
        add_spot(scene, from, to - from, half_degrees, 110, 1300.0f * rainbow(dice.between(0, 1)));
    }
}

// A shelter at a stop: panes, and two lamps under its roof.
void add_shelter(Scene& scene, float side, float z) {
    const glm::vec3 glass(0.6f, 0.8f, 1);
    const float back = side * 10.2f, front = side * 8.7f;
    add_pane(scene, {back, 0.15f, z}, {back, 0.15f, z - 5}, 2.3f, glass);
    add_pane(scene, {back, 0.15f, z - 5}, {front, 0.15f, z - 5}, 2.3f, glass);
    add_box(scene, {back, 2.45f, z - 5}, {front, 2.55f, z}, glm::vec3(0.3f));
    for (const float at : {1.2f, 3.8f})
        add_spot(scene, {(back + front) / 2, 2.4f, z - at}, {0, -1, 0}, 55, 3.5f, 6.0f * neon);
}

}  // namespace

Scene make_street() {
    Dice dice(2011);
    Scene scene;
    scene.name = "made street";
    add_paint(scene, {-120, last - 60}, {120, 60}, 0, glm::vec3(0.14f));
    for (int i = -1; i < 3; ++i)
        add_street_block(scene, dice, -block * static_cast<float>(i));
    add_tower(scene, dice);
    for (int i = 0; i < 4; ++i)
        add_shelter(scene, i % 2 == 0 ? 1.0f : -1.0f, -14.0f - 55 * static_cast<float>(i));
    scene.cameras = {look("over the street", {4.5, 9.5, 9}, {-1.5, 5.0, -60}, 50),
                     look("on the pavement", {8.6, 1.75, -3}, {2, 3.2, -60}, 55),
                     look("from above", {14, 95, 5}, {0, 0, -62}, 60)};
    return scene;
}
