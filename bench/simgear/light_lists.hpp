// SPDX-License-Identifier: MIT
// lightbin in SimGear, FlightGear's engine: fills the tables that SimGear's clustered shading reads. C++17, as SimGear
// is; light_lists.cpp is the one file in C++20.
#pragma once

#include <lightbin/lightbin.h>

#include <osg/Camera>
#include <osg/Image>

#include <simgear/structure/exception.hxx>

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

class LightLists {
public:
    /// Relative error of the depth in SimGear's shader, which finds the slice by log2 in float.
    static inline float margin = 0x1p-14f;

    LightLists() {
        lightbin_binner_options options = {};
        options.size = sizeof options;
        options.slicing = LIGHTBIN_CLUSTERS;
        options.depth_test = 1;
        lightbin_binner* binner = nullptr;
        succeed(lightbin_binner_create(&options, &binner));
        binner_.reset(binner);
    }

    /// Makes the lists of all slices, like SimGear's assignLightsToSlice(). Points and Spots are vectors of its
    /// PointlightBound and SpotlightBound, which are in view space.
    template <class Points, class Spots>
    void fill(const osg::Camera& camera, int tile_size, int slices, float near, float far,
              const Points& points, const Spots& spots, osg::Image& clusters, osg::Image& indices) {
        lightbin_view_options options = {};
        options.size = sizeof options;
        options.width = static_cast<int>(camera.getViewport()->width());
        options.height = static_cast<int>(camera.getViewport()->height());
        options.tile_size = tile_size;
        options.projection.doubles =
            camera.getProjectionMatrix().ptr();  // as it is: row vectors, translation last
        lightbin_view* view = view_.release();
        const lightbin_result made =
            view ? lightbin_view_update(view, &options) : lightbin_view_create(&options, &view);
        view_.reset(view);
        succeed(made);

        // SimGear's slices begin at near * (far / near)^(slice / slices).
        lightbin_slices* depths = nullptr;
        succeed(lightbin_slices_exponential(slices,
                                            near * std::pow(far / near, 1.0f / static_cast<float>(slices)),
                                            far, margin, &depths));
        slices_.reset(depths);

        ranges_.clear();
        for (const auto& spot : spots)
            ranges_.push_back(spot.light->getRange());
        lightbin_lights lights = {};
        lights.size = sizeof lights;
        lights.spheres.count = points.size();
        if (!points.empty()) {
            lights.spheres.centre = {points[0].position.ptr(), sizeof points[0]};
            lights.spheres.radius = {&points[0].range, sizeof points[0]};
        }
        lights.spots.count = spots.size();
        if (!spots.empty()) {
            lights.spots.centre = {spots[0].position.ptr(), sizeof spots[0]};
            lights.spots.radius = {ranges_.data(), sizeof ranges_[0]};
            lights.spots.axis = {spots[0].direction.ptr(), sizeof spots[0]};
            lights.spots.cosine = {&spots[0].cos_cutoff, sizeof spots[0]};
        }
        lightbin_inputs inputs = {};
        inputs.size = sizeof inputs;
        inputs.slices = depths;
        lightbin_grid grid = {};
        grid.size = sizeof grid;
        succeed(lightbin_bin(binner_.get(), view, &lights, &inputs, &grid));

        // SimGear's tables are floats: {start, points, spots} for each cluster, and the lights' numbers in their kind.
        // The clusters are in the same order, and in a list the points stand before the spots.
        if (grid.id_count > static_cast<std::size_t>(indices.s()) * static_cast<std::size_t>(indices.t()))
            throw sg_range_exception("more light indices than the texture holds");
        const auto* const ids = static_cast<const std::uint32_t*>(grid.ids);
        auto* cluster = reinterpret_cast<float*>(clusters.data());
        auto* const index = reinterpret_cast<float*>(indices.data());
        for (std::uint64_t cell = 0; cell < grid.range_count; ++cell, cluster += 3) {
            const lightbin_range range = grid.ranges[cell];
            std::uint32_t point_count = 0;
            for (std::uint32_t i = range.offset; i < range.offset + range.count; ++i) {
                const bool is_point = ids[i] < grid.first_spot;
                point_count += is_point;
                index[i] = static_cast<float>(is_point ? ids[i] : ids[i] - grid.first_spot);
            }
            cluster[0] = static_cast<float>(range.offset);
            cluster[1] = static_cast<float>(point_count);
            cluster[2] = static_cast<float>(range.count - point_count);
        }
    }

private:
    static void succeed(const lightbin_result& result) {
        if (result.error == LIGHTBIN_OK) return;
        char text[512];
        lightbin_error_text(result, text, sizeof text);
        throw sg_range_exception(text);
    }

    struct Destroy {
        void operator()(lightbin_view* view) const { lightbin_view_destroy(view); }
        void operator()(lightbin_binner* binner) const { lightbin_binner_destroy(binner); }
        void operator()(lightbin_slices* slices) const { lightbin_slices_destroy(slices); }
    };
    std::unique_ptr<lightbin_view, Destroy> view_;
    std::unique_ptr<lightbin_binner, Destroy> binner_;
    std::unique_ptr<lightbin_slices, Destroy> slices_;
    std::vector<float> ranges_;
};
