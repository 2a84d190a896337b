// SPDX-License-Identifier: MIT
// No list lacks a box, or a sphere cut by a box, that it should have: for every kind of camera, with and without depth
// test, in view and world space.
#include "boxes.hpp"
#include "shape_proof.hpp"

#include <lightbin/box.hpp>

using namespace oracle;

namespace {

struct BoxTally : ShapeTally {
    std::uint64_t settled = 0;  ///< cells that certainly do not meet the box, decided in double precision
    std::uint64_t exact = 0;    ///< cells decided in rational numbers, some as a check of double precision
    std::uint64_t twice = 0;    ///< of these, the cells that both methods of oracle.hpp decided
};

std::vector<lightbin::Box> as_boxes(const std::vector<BoxLight>& lights) {
    std::vector<lightbin::Box> boxes;
    for (const BoxLight& b : lights) {
        lightbin::Box box = {b.x, b.y, b.z, b.radius, b.centre[0], b.centre[1], b.centre[2], {}, b.taper};
        std::copy(&b.half_axes[0][0], &b.half_axes[0][0] + 9, &box.half_axes[0][0]);
        boxes.push_back(box);
    }
    return boxes;
}

struct Boxes {
    using Light = BoxLight;
    using Tally = BoxTally;
    static constexpr bool whole_rectangles = true, tight = false;
    static constexpr std::size_t beside = 2, others = 1, lights = 100;

    static const std::vector<BoxSet>& sets() { return box_sets(); }
    static oracle::Light ball(const BoxLight& light) { return {light.x, light.y, light.z, light.radius}; }
    static std::vector<lightbin::Box> to_library(const std::vector<BoxLight>& lights) { return as_boxes(lights); }
    static lightbin::Sphere least(const lightbin::Box& box) { return bounding_sphere(box); }

    static void check(const Tally& tally) {
        MESSAGE(tally.exact << " in rationals, " << tally.twice << " of them by both deciders");
        CHECK(tally.twice > 0);
        for (const auto& set : tally.sets)
            CHECK_MESSAGE(set.second.by_shape >= 100, set.first);
    }

    class Shapes {
    public:
        Shapes(Examiner& examiner, const std::vector<BoxLight>& lights, const ViewMatrix* matrix, Tally& tally)
            : examiner_(examiner), lights_(lights), exact_(lights.size()), tally_(tally) {
            std::optional<ExactView> view;
            if (matrix) view.emplace(*matrix);
            const auto to_camera = [&](const Vector& at) {
                return examiner.oracle.in_camera({view ? (*view)(at) : at, 0});
            };
            for (const BoxLight& light : lights)
                boxes_.push_back(is_bad(light) ? FlatBox{} : flat_box(light, to_camera));
        }

        /// Decides in double precision if possible, else in rational numbers. One in 97 of the former is checked in
        /// rational numbers, and one in 97 of the latter by a second method.
        template <class Planes>
        std::optional<bool> meets(std::size_t i, const Block& tiles, const FlatDepths& depths,
                                  const Planes& planes_of) {
            const bool settled =
                apart(examiner_.truth.filter, tiles.x0, tiles.x1, tiles.y0, tiles.y1, depths, boxes_[i]);
            if (settled && ++tally_.settled % 97 != 0) return false;
            auto planes = planes_of();
            if (!exact_[i]) exact_[i].emplace(lights_[i]);
            const bool meet = oracle::meets(planes, *exact_[i]);
            if (++tally_.exact % 97 == 0) {
                ++tally_.twice;
                planes.insert(planes.end(), exact_[i]->faces.begin(), exact_[i]->faces.end());
                REQUIRE(meet == oracle::meets(planes, exact_[i]->ball));
            }
            REQUIRE(!(settled && meet));
            return meet;
        }

    private:
        Examiner& examiner_;
        const std::vector<BoxLight>& lights_;
        std::vector<std::optional<ExactBox>> exact_;
        std::vector<FlatBox> boxes_;
        Tally& tally_;
    };
};

}  // namespace

TEST_CASE("no list lacks a box") {
    prove_all<Boxes>();
}
