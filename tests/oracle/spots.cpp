// SPDX-License-Identifier: MIT
// No list lacks a spot that it should have: for every kind of camera, with and without depth test, in view and world
// space. The spot itself is tested, not the sphere around it.
#include "spots.hpp"
#include "shape_proof.hpp"

#include <lightbin/spot.hpp>

using namespace oracle;

namespace {

std::vector<lightbin::Spot> as_spots(const std::vector<SpotLight>& lights) {
    std::vector<lightbin::Spot> spots;
    for (const SpotLight& s : lights)
        spots.push_back({s.ball.x, s.ball.y, s.ball.z, s.ball.w, s.axis_x, s.axis_y, s.axis_z, s.cosine});
    return spots;
}

struct Spots {
    using Light = SpotLight;
    using Tally = ShapeTally;
    static constexpr bool whole_rectangles = false, tight = false;
    static constexpr std::size_t beside = 1, others = 2, lights = 60;

    static const std::vector<SpotSet>& sets() { return spot_sets(); }
    static oracle::Light ball(const SpotLight& light) { return light.ball; }
    static std::vector<lightbin::Spot> to_library(const std::vector<SpotLight>& lights) { return as_spots(lights); }
    static lightbin::Sphere least(const lightbin::Spot& spot) { return bounding_sphere(spot); }

    static void check(const Tally&) {}

    class Shapes {
    public:
        Shapes(Examiner&, const std::vector<SpotLight>& lights, const ViewMatrix*, Tally&) {
            for (const SpotLight& light : lights)
                exact_.push_back(exact_spot(is_bad(light) ? SpotLight{{}, 0, 0, 1, 1} : light));
        }
        template <class Planes>
        std::optional<bool> meets(std::size_t i, const Block&, const FlatDepths&, const Planes& planes) const {
            return oracle::meets(planes(), exact_[i]);
        }

    private:
        std::vector<ExactSpot> exact_;
    };
};

}  // namespace

TEST_CASE("no list lacks a spot") {
    prove_all<Spots>();
}
