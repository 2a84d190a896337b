// SPDX-License-Identifier: MIT
#include "spots_time.hpp"

#include "lens.hpp"
#include "slicing.hpp"
#include "spots_sets.hpp"
#include "tiers.hpp"

#include <lightbin/binner.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using lightbin::DepthTest;
using lightbin::Footprint;
using lightbin::Options;
using lightbin::Slicing;

constexpr Goal time_goal = {1.5, 1.2};

struct SpotFrame {
    Spots lights;
    Lights spheres;  ///< around the same centres
};

/// Frames of a set, met in turn.
class SpotFrames {
public:
    SpotFrames(std::size_t count, float median_range) {
        for (std::uint32_t seed = 0; seed < rotation(count); ++seed) {
            frames_.push_back({spot_field(count, median_range, seed), field(count, median_range, seed)});
            ranges_.push_back(frames_.back().spheres);
        }
    }

    const std::vector<SpotFrame>& get() const { return frames_; }

    /// Scales all spheres until they make as many entries as the spots: entries(lights) of a frame's.
    template <class Entries> void match(Entries entries) {
        std::size_t wanted = 0;
        for (const SpotFrame& frame : frames_)
            wanted += entries(frame.lights);
        double low = 0.01, high = 4;
        for (int step = 0; step < 20; ++step) {
            const double scale = std::sqrt(low * high);
            scale_spheres(float(scale));
            std::size_t made = 0;
            for (const SpotFrame& frame : frames_)
                made += entries(frame.spheres);
            if (std::abs(double(made) - double(wanted)) < 0.005 * double(wanted)) return;
            (made < wanted ? low : high) = scale;
        }
    }

private:
    void scale_spheres(float scale) {
        for (std::size_t i = 0; i < frames_.size(); ++i)
            for (std::size_t k = 0; k < ranges_[i].size(); ++k)
                frames_[i].spheres[k].w = scale * ranges_[i][k].w;
    }

    std::vector<SpotFrame> frames_;
    std::vector<Lights> ranges_;
};

struct SpotSet {
    const char* name;
    std::size_t lights;
    float median_range;
};

/// The frames of the set that was asked for last, their spheres matched to its rung.
class KeptFrames {
public:
    template <class Entries>
    const std::vector<SpotFrame>& matched(const SpotSet& set, const std::string& rung, Entries entries) {
        const std::string name = std::string(set.name) + "/" + std::to_string(set.lights);
        if (name != set_) frames_ = std::make_unique<SpotFrames>(set.lights, set.median_range);
        if (name != set_ || rung != rung_) frames_->match(entries);
        set_ = name, rung_ = rung;
        return frames_->get();
    }

private:
    std::string set_, rung_;
    std::unique_ptr<SpotFrames> frames_;
};

template <Options options> std::string rung_name() {
    return std::string(to_string(options.footprint)) + "/" + to_string(options.depth_test) + "/" +
           to_string(options.slicing);
}

template <Options options> SpotTime time_spots(const SpotSet& set, KeptFrames& kept, double seconds_a_case) {
    constexpr bool sliced = options.slicing != Slicing::none,
                   clustered = options.slicing == Slicing::clusters;
    constexpr int tile_size = clustered ? 64 : 32;
    static const MadeBounds bounds(tile_size);
    const lightbin::View view = Lens().view(tile_size);
    const lightbin::Slices slices = clustered ? cluster_slices() : z_bin_slices();
    const auto entries_by = [&](auto& binner, const auto& lights) {
        if constexpr (sliced)
            return binner.bin(view, lights, {.slices = slices})->ids().size();
        else
            return binner.bin(view, lights, lightbin::inputs_for<options>(bounds.bounds))->ids().size();
    };
    lightbin::Binner<with(options, lightbin::compiled_isa)> widest;  // the lists are the same
    const std::vector<SpotFrame>& frames = kept.matched(
        set, rung_name<options>(), [&](const auto& lights) { return entries_by(widest, lights); });
    lightbin::Binner<options> binner;
    const auto entries = [&](const auto& lights) { return entries_by(binner, lights); };
    std::size_t of_spots = 0, of_spheres = 0;
    const Turns turns = take_turns(
        frames, seconds_a_case, [&](const SpotFrame& frame) { of_spots += entries(frame.lights); },
        [&](const SpotFrame& frame) { of_spheres += entries(frame.spheres); });
    const SlicingResult result = slicing_result(turns, set.name, set.lights, options, of_spots);
    const double all = double(set.lights * turns.together);
    return {.set = set.name,
            .lights = set.lights,
            .footprint = to_string(options.footprint),
            .depth_test = result.depth_test,
            .slicing = result.slicing,
            .tier = result.tier,
            .ns_per_spot = result.ns_per_light,
            .ns_per_sphere = 1e9 * median(turns.theirs) / all,
            .ratio = result.ratio,
            .spread = result.spread,
            .entries = result.entries_per_light,
            .entries_of_spheres = double(of_spheres) / (all * double(turns.theirs.size()))};
}

template <Options options>
void add_rung(const SpotSet& set, const std::shared_ptr<KeptFrames>& kept, std::vector<SpotTimeCase>& cases) {
    each_tier<options>([&]<Options one>() {
        cases.push_back({std::string("spots/") + set.name + "/" + std::to_string(set.lights) + "/" +
                             rung_name<one>() + "/" + to_string(one.isa),
                         [=](double seconds) { return time_spots<one>(set, *kept, seconds); }});
    });
}

}  // namespace

std::vector<SpotTimeCase> spot_time_cases(bool quick) {
    const auto kept = std::make_shared<KeptFrames>();
    std::vector<SpotTimeCase> cases;
    for (const auto& [name, median_range] : {std::pair("spots20", spots20_median), {"spots4", spots4_median}})
        for (const std::size_t count : {256u, 1000u, 4096u, 10000u}) {
            if (quick && (count == 256 || count == 4096 || median_range == spots4_median)) continue;
            const SpotSet set = {name, count, median_range};
            add_rung<Options{}>(set, kept, cases);
            add_rung<Options{.footprint = Footprint::silhouette}>(set, kept, cases);
            add_rung<Options{.depth_test = DepthTest::interval}>(set, kept, cases);
            add_rung<Options{.depth_test = DepthTest::box}>(set, kept, cases);
            add_rung<Options{.depth_test = DepthTest::split_box}>(set, kept, cases);
            add_rung<Options{.slicing = Slicing::clusters}>(set, kept, cases);
            add_rung<Options{.depth_test = DepthTest::box, .slicing = Slicing::clusters}>(set, kept, cases);
            add_rung<Options{.slicing = Slicing::z_bins}>(set, kept, cases);
        }
    return cases;
}

void write_spot_times(const std::vector<SpotTime>& times, const char* path) {
    std::FILE* const csv =
        open_report(path, "set,n,footprint,depth_test,slicing,tier,ns_per_spot,ns_per_sphere,ratio,"
                          "spread,entries,entries_of_spheres");
    for (const SpotTime& t : times)
        std::fprintf(csv, "%s,%zu,%s,%s,%s,%s,%.3f,%.3f,%.4f,%.4f,%.3f,%.3f\n", t.set.c_str(), t.lights,
                     t.footprint.c_str(), t.depth_test.c_str(), t.slicing.c_str(), t.tier.c_str(),
                     t.ns_per_spot, t.ns_per_sphere, t.ratio, t.spread, t.entries, t.entries_of_spheres);
    std::fclose(csv);
}

void add_spot_time_goals(const std::vector<SpotTime>& times, Goals& goals) {
    std::map<std::pair<std::string, std::string>, const SpotTime*> worst;  // by rung and tier
    for (const SpotTime& t : times) {
        const SpotTime*& most = worst[{t.rung(), t.tier}];
        if (most == nullptr || t.ratio > most->ratio) most = &t;
    }
    for (const auto& [rung, time] : worst)
        goals.add("spots to spheres", rung.first + text(": %s/%zu", time->set.c_str(), time->lights),
                  rung.second, time_goal, time->ratio);
}
