// SPDX-License-Identifier: MIT
// No list lacks a sphere that it should have: for every kind of camera, with and without depth test, in view and world
// space. Nor has a list more than rectangles, depths and boxes explain.
#include "shape_proof.hpp"
#include "spheres.hpp"

using namespace oracle;

namespace {

struct Spheres {
    using Light = oracle::Light;
    using Tally = ShapeTally;
    static constexpr bool whole_rectangles = true, tight = true;
    static constexpr std::size_t beside = 1000, others = 1000, lights = 600;

    static const std::vector<SphereSet>& sets() { return sphere_sets(); }
    static Light ball(const Light& light) { return light; }
    static const std::vector<Light>& to_library(const std::vector<Light>& lights) { return lights; }
    static lightbin::Sphere least(const Light& light) { return {light.x, light.y, light.z, light.w}; }

    static void check(const Tally&) {}

    class Shapes {
    public:
        Shapes(Examiner&, const std::vector<Light>& lights, const ViewMatrix* matrix, Tally&) : matrix_(matrix) {
            for (const Light& light : lights)
                balls_.push_back(is_bad(light) ? Ball{} : exact_ball(light));
        }

        template <class Planes>
        std::optional<bool> meets(std::size_t i, const Block&, const FlatDepths&, const Planes& planes_of) const {
            const std::vector<HalfSpace> planes = planes_of();
            const Ball& ball = balls_[i];
            const auto beyond = [&](const HalfSpace& plane) {
                const Rational at = plane.at(ball.centre);
                return !ball.all && at < 0 && square(at) > square(ball.radius) * dot(plane.a, plane.a);
            };
            return std::none_of(planes.begin(), planes.end(), beyond) && oracle::meets(planes, ball);
        }

        /// Returns a sphere in view space whose rectangle explains that of the light. A rotation and scale gives the
        /// moved sphere, allowing for rounding; other maps give none. If the moved centre is no finite float, the
        /// sphere is everywhere.
        std::optional<Ball> as_seen(std::size_t i) const {
            const Ball& ball = balls_[i];
            if (matrix_ == nullptr) return ball;
            if (matrix_->stretch == 0 || ball.all) return std::nullopt;
            const ExactView view(*matrix_);
            const Rational stretch = exact(matrix_->stretch);
            Ball image{view(ball.centre), ball.radius * stretch};
            const auto size = [](const Vector& v) { return abs(v.x) + abs(v.y) + abs(v.z); };
            const Rational reach = image.radius + size(image.centre);
            if (reach > exact(FLT_MAX)) return std::nullopt;
            const Rational terms = stretch * size(ball.centre) + size(view.column[3]);
            image.radius += reach / (1 << 20) + terms / (std::int64_t{1} << 44) + exact(0x1p-125);
            return image;
        }

    private:
        std::vector<Ball> balls_;
        const ViewMatrix* matrix_;
    };
};

}  // namespace

TEST_CASE("no list lacks a sphere") {
    prove_all<Spheres>();
}
