// SPDX-License-Identifier: MIT
// Times SimGear's clustered shading with and without lightbin in turns, and counts the lights that its shader does not
// find. bench/simgear.sh makes both classes from SimGear's file; OwnShading differs only in its name.
#include "LightbinShading.hxx"
#include "OwnShading.hxx"

#include <osg/MatrixTransform>
#include <osg/Texture>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace simgear::compositor {
const SGPropertyNode* getPropertyChild(const SGPropertyNode* node, const char* name) {
    return node->getNode(name);
}
}  // namespace simgear::compositor

namespace {

constexpr int width = 1920, height = 1080;
constexpr float near = 0.5f, far = 10000;

struct Case {
    int points, spots, tile_size, slices;
};

osg::ref_ptr<osg::Camera> make_camera() {
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, width, height);
    camera->setProjectionMatrixAsPerspective(60, static_cast<double>(width) / height, near, far);
    return camera;
}

/// Adds a light at a place in view space, which is also world space here.
void add(SGLightList& lights, const osg::Vec3d& place, float range, float cutoff,
         const osg::Vec3d& direction) {
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(
        osg::Matrixd::rotate(osg::Vec3d(0, 0, -1), direction) * osg::Matrixd::translate(place));
    osg::ref_ptr<SGLight> light = new SGLight;
    light->type = cutoff < 180 ? SGLight::SPOT : SGLight::POINT;
    light->range = range;
    light->cutoff = cutoff;
    transform->addChild(light);
    transform->ref();  // kept: a node does not keep its parents
    lights.push_back(light);
}

/// Lights between 1 and 600 units away, evenly in depth and on the screen, with ranges of 2 to 15.
SGLightList make_lights(const Case& c) {
    SGLightList lights;
    std::minstd_rand random(5);
    const auto any = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
    for (int i = 0; i < c.points + c.spots; ++i) {
        const float depth = any(1, 600), across = 1.1f * depth, up = 0.62f * depth;
        const osg::Vec3d place(any(-across, across), any(-up, up), -depth),
            direction(any(-1, 1), any(-1, 0.2f), any(-1, 1));
        add(lights, place, any(2, 15), i < c.points ? 180 : any(10, 60), direction);
    }
    return lights;
}

template <class Shading> class Tables {
public:
    osg::ref_ptr<osg::Camera> camera = make_camera();

    explicit Tables(const Case& c) : case_(c) {
        SGPropertyNode config;
        config.children["max-pointlights"].value = c.points + 1;
        config.children["max-spotlights"].value = c.spots + 1;
        config.children["max-light-indices"].value = 2048;
        config.children["tile-size"].value = c.tile_size;
        config.children["depth-slices"].value = c.slices;
        config.children["pbr-lights"].value = 1;
        shading_ = new Shading(camera, &config);
    }
    void update(const SGLightList& lights) { shading_->update(lights); }

    /// Returns whether the shader, in float, finds light number `light` of its kind at a pixel and a depth.
    bool lists(int x, int y, float depth, int light, bool is_spot) const {
        const float at =
            std::log2(depth) * uniform("fg_ClusteredSliceScale") + uniform("fg_ClusteredSliceBias");
        const int slice = std::min(static_cast<int>(std::max(at, 0.0f)), case_.slices - 1);
        const float* cluster = reinterpret_cast<const float*>(
            texture(11)->data(x / case_.tile_size, y / case_.tile_size, slice));
        const float* begin =
            reinterpret_cast<const float*>(texture(12)->data()) + static_cast<int>(cluster[0]);
        const float* end = begin + static_cast<int>(cluster[1]);
        if (is_spot) begin = end, end += static_cast<int>(cluster[2]);
        return std::find(begin, end, static_cast<float>(light)) != end;
    }

    std::size_t entries() const {
        const float* cluster = reinterpret_cast<const float*>(texture(11)->data());
        const std::size_t count = texture(11)->getTotalSizeInBytes() / 12;
        std::size_t sum = 0;
        for (std::size_t i = 0; i < count; ++i)
            sum += static_cast<std::size_t>(cluster[3 * i + 1] + cluster[3 * i + 2]);
        return sum;
    }

private:
    float uniform(const char* name) const {
        float value = 0;
        camera->getStateSet()->getUniform(name)->get(value);
        return value;
    }
    const osg::Image* texture(unsigned unit) const {
        return dynamic_cast<osg::Texture*>(
                   camera->getStateSet()->getTextureAttribute(unit, osg::StateAttribute::TEXTURE))
            ->getImage(0);
    }

    Case case_;
    osg::ref_ptr<Shading> shading_;
};

/// Counts the lights that end at a depth near a boundary of slices and are not found at that depth.
template <class Shading> int lost_tangents(int slices, int* count) {
    const Case c = {4000, 0, 128, slices};
    Tables<Shading> tables(c);
    SGLightList lights;
    std::vector<float> depths;
    const double direction = 0.02;
    for (int slice = 1; slice < slices; ++slice) {
        const float boundary =
            near * std::pow(far / near, static_cast<float>(slice) / static_cast<float>(slices));
        for (int step = -40; step <= 40; ++step) {
            float depth = boundary;
            for (int i = 0; i < std::abs(step); ++i)
                depth = std::nextafter(depth, step < 0 ? 0 : far);
            for (const double radius : {depth * -0.5, depth * 0.5}) {
                // SimGear stores floats: only lights whose end is exactly this depth in float count.
                const float centre = static_cast<float>(depth + radius),
                            range = static_cast<float>(std::abs(radius));
                if (std::abs(static_cast<double>(centre) - depth) != static_cast<double>(range)) continue;
                add(lights, {direction * depth, direction * depth, -centre}, range, 180, {0, 0, -1});
                depths.push_back(depth);
            }
        }
    }
    tables.update(lights);
    const double scale = height / 2 / std::tan(osg::PI / 6);
    const int x = static_cast<int>(width / 2 + direction * scale),
              y = static_cast<int>(height / 2 + direction * scale);
    int lost = 0;
    for (std::size_t i = 0; i < lights.size(); ++i)
        lost += !tables.lists(x, y, depths[i], static_cast<int>(i), false);
    *count = static_cast<int>(lights.size());
    return lost;
}

/// Counts the lights that reach pixels at random depths but are not found there by the shader.
template <class Shading>
long lost_pairs(const Tables<Shading>& tables, const SGLightList& lights, const Case& c, long* pairs) {
    std::minstd_rand random(9);
    const double scale = height / 2 / std::tan(osg::PI / 6);
    long lost = 0;
    *pairs = 0;
    for (int i = 0; i < 20000; ++i) {
        const int x = std::uniform_int_distribution(0, width - 1)(random),
                  y = std::uniform_int_distribution(0, height - 1)(random);
        const float depth = std::uniform_real_distribution(1.0f, 600.0f)(random);
        const osg::Vec3d at((x + 0.5 - width / 2) / scale * depth, (y + 0.5 - height / 2) / scale * depth,
                            -depth);
        for (int light = 0; light < c.points + c.spots; ++light) {
            const bool is_spot = light >= c.points;
            const osg::Matrixd matrix = lights[static_cast<std::size_t>(light)]
                                            ->getParent(0)
                                            ->asTransform()
                                            ->asMatrixTransform()
                                            ->getMatrix();
            const osg::Vec3d way = at - matrix.getTrans();
            const SGLight& it = *lights[static_cast<std::size_t>(light)];
            if (way.length() > it.range * (1 - 1e-6)) continue;
            osg::Vec3d axis = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, -1), matrix);
            axis.normalize();
            if (is_spot &&
                way * axis < way.length() * std::cos(osg::DegreesToRadians(it.cutoff)) + 1e-6 * it.range)
                continue;
            ++*pairs;
            lost += !tables.lists(x, y, depth, is_spot ? light - c.points : light, is_spot);
        }
    }
    return lost;
}

template <class Shading> double seconds(Tables<Shading>& tables, const SGLightList& lights) {
    const auto begin = std::chrono::steady_clock::now();
    tables.update(lights);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main() {
    using Own = simgear::compositor::OwnShading;
    using Lightbin = simgear::compositor::LightbinShading;
    std::printf("update() at %d x %d, the least of the turns, in microseconds\n\n", width, height);
    std::printf("points + spots, tile, slices     SimGear    lightbin   times as fast   entries of both   "
                "lost of the pairs\n");
    long all_lost = 0;
    for (const Case& c : {Case{200, 100, 32768, 1}, Case{200, 100, 128, 1}, Case{500, 200, 128, 24},
                          Case{4000, 1000, 64, 24}}) {
        const SGLightList lights = make_lights(c);
        Tables<Own> own(c);
        Tables<Lightbin> lightbin(c);
        double of_own = HUGE_VAL, of_lightbin = HUGE_VAL;
        for (int turn = 0; turn < (c.slices == 1 ? 200 : c.points > 1000 ? 3 : 40); ++turn) {
            of_own = std::min(of_own, seconds(own, lights));
            for (int again = 0; again < 10; ++again)
                of_lightbin = std::min(of_lightbin, seconds(lightbin, lights));
        }
        long pairs = 0;
        const long own_lost = lost_pairs(own, lights, c, &pairs),
                   lost = lost_pairs(lightbin, lights, c, &pairs);
        all_lost += lost;
        std::printf("%5d + %4d %8d px %7d %11.0f %11.0f %15.1f %9zu %9zu %5ld and %ld of %ld\n", c.points,
                    c.spots, c.tile_size, c.slices, 1e6 * of_own, 1e6 * of_lightbin, of_own / of_lightbin,
                    own.entries(), lightbin.entries(), own_lost, lost, pairs);
    }

    int count = 0, own_lost = 0, without = 0, with = 0, sum = 0;
    const float margin = LightLists::margin;
    for (const int slices : {12, 16, 20, 24}) {
        own_lost += lost_tangents<Own>(slices, &count);
        LightLists::margin = 0;
        without += lost_tangents<Lightbin>(slices, &count);
        LightLists::margin = margin;
        with += lost_tangents<Lightbin>(slices, &count);
        sum += count;
    }
    std::printf("\nof %d lights that end at a boundary of slices, the shader does not find there: %d in SimGear's "
                "tables, %d in lightbin's without a margin, %d with it\n",
                sum, own_lost, without, with);
    return all_lost == 0 && with == 0 ? 0 : 1;
}
