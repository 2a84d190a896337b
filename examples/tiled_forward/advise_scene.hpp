// SPDX-License-Identifier: MIT
// What a scene does not need: lightbin's advice on one of its views, with costs that were measured on this machine.
#pragma once

#include "binned_lights.hpp"
#include "cpu_depth.hpp"
#include "scene.hpp"

#include <lightbin/advise.hpp>

#include <string>
#include <vector>

// A view of a scene in tiles of 8 pixels, and what lightbin::advise() asks of it.
class AdvisedView {
public:
    AdvisedView(const Scene& scene, const Camera& camera, lightbin::ImageSize size);

    const lightbin::View& view() const { return view_; }
    double overdraw() const { return depth_.overdraw; }
    double reduce_ns() const { return reduce_ns_; }  // to reduce the depth buffer to Z bounds, on this core

    // The evaluations of lights and boxes by plain tiles of 16 pixels, without a pre-pass.
    double plain_evaluations();

    // Every plan of lightbin::advise(), with Z bounds, and of advise_slices(). The overdraw is the view's.
    lightbin::Advice advise(lightbin::AdviceCosts costs) const;

    // The call that makes the slices of these plans.
    std::string slices_in_words(lightbin::Slicing slicing) const;

private:
    lightbin::View view_;
    BinnedLights lights_;
    CpuDepth depth_;
    std::vector<float> min_, max_;
    double reduce_ns_;
    lightbin::Slices clusters_, z_bins_;
};

struct AdviseSettings {
    int width = 1280, height = 720;
    int glsl = 0;   // as for OffscreenContext
    int view = -1;  // which camera; -1: the one whose pixels have the longest lists
};

// Measures, and returns what was found as a page of text of at most 40 lines of 100 columns, which ends with the
// lines of C++ that do as is advised. Needs no OpenGL: without one it says what it assumes in place of what it would
// have measured. Throws std::runtime_error with one line of text.
std::string advise_scene(const Scene& scene, const AdviseSettings& settings);
