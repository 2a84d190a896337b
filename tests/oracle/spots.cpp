// SPDX-License-Identifier: MIT
// Spots: no miss, on every camera kind, with every footprint and depth test, in view and world space. What is asked is
// the spot itself, not the sphere that it is binned as.
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

/// World-space spots that land, more or less, where a set wants them in view space.
std::vector<SpotLight> into_world(std::vector<SpotLight> lights, const ViewMatrix& view) {
    for (SpotLight& s : lights) {
        const float size = s.ball.w / std::hypot(s.axis_x, s.axis_y, s.axis_z);
        const Light tip = {s.ball.x + size * s.axis_x, s.ball.y + size * s.axis_y, s.ball.z + size * s.axis_z, 0};
        const std::vector<Light> both = into_world({s.ball, tip}, view);
        s = {both[0], both[1].x - both[0].x, both[1].y - both[0].y, both[1].z - both[0].z, s.cosine};
    }
    return lights;
}

struct Spots {
    using Light = SpotLight;
    using Tally = ShapeTally;
    static constexpr bool whole_rectangles = false;
    static constexpr std::size_t beside = 1, others = 2;

    static const std::vector<SpotSet>& sets() { return spot_sets(); }
    static oracle::Light ball(const SpotLight& light) { return light.ball; }
    static std::vector<lightbin::Spot> to_library(const std::vector<SpotLight>& lights) { return as_spots(lights); }
    static lightbin::Sphere least(const lightbin::Spot& spot) { return least_sphere(spot); }
    static std::vector<SpotLight> into_world(const std::vector<SpotLight>& lights, const ViewMatrix& view) {
        return ::into_world(lights, view);
    }

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

#define PROVE(kind)                                                                                                    \
    TEST_CASE("spots: " #kind) {                                                                                       \
        prove_in_view_space<Spots>(#kind, kinds::kind(), 84);                                                          \
    }
ORACLE_CAMERA_KINDS(PROVE)

TEST_CASE("spots: world space") {
    prove_in_world_space<Spots>();
}

// By the campaign, which asks for more than a test has time for.
TEST_CASE("spots: missed once") {
    struct Missed {
        Camera camera;
        SpotLight spot;
        int x, y;
    };
    const Screen& screen = screens()[3];
    Lens close = symmetric_lens(aspect_of(screen), 75);
    close.zero_to_one = true, close.near_plane = 1e-5;
    // Half angles of 89.8 degrees: the sine and the length of the axis as floats tilted the wedge too far.
    const Missed all[] = {{camera_of("wide fov", symmetric_lens(aspect_of(screen), 170), screen),
                           {{-0x1.b6e13ap+11f, -0x1.7d055cp+8f, -0x1.2ead24p+9f, 0x1.f35bbp+8f},
                            0x1.dfd71ap-10f,
                            -0x1.b07292p-1f,
                            0x1.121a44p-1f,
                            0x1.de77bep-9f},
                           15,
                           19},
                          {camera_of("right-handed [0,1]", close, screen),
                           {{0x1.1888e4p-19f, 0x1.c98bb4p-18f, -0x1.778138p-16f, 0x1.b9d34cp-21f},
                            0x1.5000dcp+10f,
                            0x1.d43846p+1f,
                            0x1.f54df4p+6f,
                            0x1.63a5aep-9f},
                           35,
                           10}};
    for (const Missed& m : all) {
        const Oracle oracle(m.camera);
        CHECK(meets(oracle.half_spaces(oracle.columns(m.x, m.x + 1), oracle.rows(m.y, m.y + 1), oracle.depths()),
                    exact_spot(m.spot)) == true);
        lightbin::Binner<lightbin::Options{.footprint = lightbin::Footprint::silhouette}> binner;
        const auto grid = *binner.bin(view_of(m.camera), as_spots({m.spot}));
        CHECK_MESSAGE(grid.lights_in(m.x, m.y).size() == 1, m.camera.name);
    }
}
