// SPDX-License-Identifier: MIT
// What bench/simgear adds to SimGear, without SimGear's source: the tables that its shader reads are filled, and the
// shader finds each light in them, although it looks slices up by log2 in float.
#include "light_lists.hpp"

#include <simgear/scene/model/SGLight.hxx>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace {

// As SimGear's.
struct Point {
    osg::Vec4f position;
    float range;
};
struct Spot {
    SGLight* light;
    osg::Vec4f position, direction;
    float cos_cutoff;
};

constexpr int tile_size = 64, slices = 24, columns = 10, rows = 8;
constexpr float near = 0.5f, far = 10000;

/// Counts the points and spots that end at a depth near a boundary of slices and are not in the list read at that
/// depth.
int count_lost(float margin, int* lights) {
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, columns * tile_size, rows * tile_size - 7);
    camera->setProjectionMatrixAsPerspective(60, 1.2, near, far);
    std::vector<Point> points;
    std::vector<Spot> spots;
    std::vector<osg::ref_ptr<SGLight>> owners;
    std::vector<float> depths;
    for (int slice = 1; slice < slices; ++slice)
        for (int step = -40; step <= 40; ++step) {
            float depth = near * std::pow(far / near, static_cast<float>(slice) / static_cast<float>(slices));
            for (int i = 0; i < std::abs(step); ++i)
                depth = std::nextafter(depth, step < 0 ? 0 : far);
            points.push_back({{0.01f * depth, 0.01f * depth, -2 * depth, 1}, depth});  // nearest at the depth
            owners.push_back(new SGLight);
            owners.back()->range = depth / 2;  // farthest there, where it shines to
            spots.push_back(
                {owners.back(), {0.01f * depth, 0.01f * depth, -depth / 2, 1}, {0, 0, -1, 0}, 0.8f});
            depths.push_back(depth);
        }
    const osg::ref_ptr<osg::Image> clusters = new osg::Image, indices = new osg::Image;
    clusters->allocateImage(columns, rows, slices, GL_RGB, GL_FLOAT);
    indices->allocateImage(1024, 1024, 1, GL_RED, GL_FLOAT);
    LightLists lists;
    LightLists::margin = margin;
    lists.fill(*camera, tile_size, slices, near, far, points, spots, *clusters, *indices);

    const float scale = slices / std::log2(far / near),
                bias = -slices * std::log2(near) / std::log2(far / near);
    int lost = 0;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const int slice = std::clamp(static_cast<int>(std::log2(depths[i]) * scale + bias), 0, slices - 1);
        const auto* const cluster = reinterpret_cast<const float*>(
            clusters->data(columns / 2, rows / 2 - 1, static_cast<unsigned>(slice)));
        const auto* const begin =
            reinterpret_cast<const float*>(indices->data()) + static_cast<int>(cluster[0]);
        const auto* const middle = begin + static_cast<int>(cluster[1]);
        const auto* const end = middle + static_cast<int>(cluster[2]);
        lost += std::find(begin, middle, static_cast<float>(i)) == middle;
        lost += std::find(middle, end, static_cast<float>(i)) == end;
    }
    *lights = static_cast<int>(2 * depths.size());
    return lost;
}

}  // namespace

int main() {
    int lights = 0;
    const int with = count_lost(LightLists::margin, &lights), without = count_lost(0, &lights);
    std::printf("of %d lights the shader does not find: %d, and without a margin %d\n", lights, with,
                without);
    return with == 0 && 0 < without && without < lights / 2 ? 0 : 1;
}
