// The light grid: both types of ids, lengths of lists, the View that an error recommends, and oblique near planes.
// tests/oracle and tests/hunt test that no light is missed.
#include "scene.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

using namespace lightbin;

TEST_CASE("16-bit ids are the same ids") {
    const View view = test::view({1280, 720}, 32);
    const auto lights = test::random_lights(65536, 14);  // as many as there are ids
    CHECK(test::lists<Options{.ids = IdWidth::u16}>(view, lights) == test::lists(view, lights));
}

TEST_CASE("how long the longest list is") {
    const View view = test::view({960, 540}, 16);
    auto lights = test::random_lights(150, 23);
    std::erase_if(lights, [](const glm::vec4& light) { return light.z > -5; });  // leaves tiles empty
    lights.resize(20);
    Binner<> binner;
    const auto grid = binner.bin(view, lights);
    REQUIRE(grid);
    std::size_t longest = 0;
    for (const auto& list : test::to_lists(*grid))
        longest = std::max(longest, list.size());
    CHECK(longest > 0);
    CHECK(longest_list(*grid) == longest);
    CHECK(longest_list(*binner.bin(view, std::vector<glm::vec4>())) == 0);
}

TEST_CASE("turned by 90 and 270 degrees, as Android's pre-rotation does: no point's pixel lacks the point's light") {
    const auto lights = test::random_lights(300, 31);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> side(-0.57f, 0.57f);
    std::size_t points = 0, missed = 0;
    for (const glm::mat4& upright : {glm::perspectiveRH_NO(1.0f, 1.777f, 0.1f, 1000.0f),
                                     glm::orthoRH_NO(-30.0f, 50.0f, -20.0f, 25.0f, -1.0f, 90.0f)})
        for (const float up : {-1.0f, 1.0f})
            for (const auto& [columns, rows] : {std::pair(0, 0), {9, 16}})
                for (const WindowOrigin origin : {WindowOrigin::lower_left, WindowOrigin::upper_left}) {
                    glm::mat4 turned = upright;
                    for (int column = 0; column < 4; ++column)
                        turned[column] = {up * upright[column].y, -up * upright[column].x, upright[column].z,
                                          upright[column].w};
                    const View view = *View::from_projection(
                        turned, {1080, 1920}, {.columns = columns, .rows = rows, .origin = origin});
                    REQUIRE(view.turned());
                    CHECK(view.tiles_x() == (columns > 0 ? 16 : 60));
                    Binner<> binner;
                    const auto grid = binner.bin(view, lights);
                    for (int i = 0; i < 100'000; ++i) {
                        const std::size_t id = static_cast<std::size_t>(i) % lights.size();
                        const glm::vec4& light = lights[id];
                        const glm::vec4 offset(side(random), side(random), side(random), 0),
                            clip = turned * (glm::vec4(light.x, light.y, light.z, 1) + light.w * offset);
                        if (!glm::all(glm::lessThan(glm::abs(glm::vec3(clip)), glm::vec3(0.9999f * clip.w)))) continue;
                        const float y = origin == WindowOrigin::lower_left ? clip.y : -clip.y;
                        const auto tile = view.tile_of_pixel(static_cast<int>((clip.x / clip.w + 1) / 2 * 1080),
                                                             static_cast<int>((y / clip.w + 1) / 2 * 1920));
                        const auto list = grid->lights_in(tile->x, tile->y);
                        ++points;
                        missed += !std::ranges::binary_search(list, static_cast<std::uint32_t>(id));
                    }
                }
    CHECK(points > 400'000);
    CHECK(missed == 0);
}

namespace {

/// The projection with `plane` as its near plane: E. Lengyel, Oblique View Frustum Depth Projection and Clipping, 2005.
glm::dmat4 with_near_plane(glm::dmat4 projection, const glm::dvec4& plane) {
    const glm::dmat4 transposed = glm::transpose(projection);
    const glm::dvec4 corner =
        glm::inverse(projection) * glm::dvec4(glm::sign(plane.x), glm::sign(plane.y), 1, 1);
    const double scale = 2 * glm::dot(transposed[3], corner) / glm::dot(plane, corner);
    for (int i = 0; i < 4; ++i)
        projection[i][2] = plane[i] * scale - transposed[3][i];
    return projection;
}

}  // namespace

// A mirror before the eye, as it was reported. Its matrix draws nearer than the near plane of the matrix that it was
// made of, and beyond the far plane.
TEST_CASE("an oblique near plane: what its matrix draws is listed, and window depths are those of its pixels") {
    for (const bool zero_to_one : {false, true}) {
        glm::dmat4 matrix = glm::perspective(std::acos(0.0), 1.0, 1.0, 10.0);
        const glm::dvec4 plane(0, 0.6, -0.8, -0.25);
        const double inside = glm::dot(plane, glm::dvec4(0, 1, -1, (1 + matrix[2][2]) / matrix[3][2]));
        for (int i = 0; i < 4; ++i)  // z / w runs from 0 or -1 at the plane
            matrix[i][2] = zero_to_one ? plane[i] / inside : plane[i] * 2 / inside - matrix[i][3];
        const ClipDepth clip_depth = zero_to_one ? ClipDepth::zero_to_one : ClipDepth::minus_one_to_one;
        const View view = *View::from_projection(matrix, {256, 256}, {.clip_depth = clip_depth});
        CHECK(view.near_depth() == doctest::Approx(0.25 / 1.4));  // at the image's upper side
        CHECK(view.far_depth() == HUGE_VALF);
        CHECK(std::string(to_string(view.summary())).ends_with(", oblique near plane (0, 0.6, -0.8, -0.25)"));

        const auto lists = test::lists(view, std::vector<Sphere>{{0, 0, -0.6f, 0.1f}, {0, 0, -20, 1}, {0, -3, -40, 2}});
        CHECK(lists[4 * 8 + 4] == std::vector<std::uint32_t>{0, 1});
        CHECK(lists[3 * 8 + 4] == std::vector<std::uint32_t>{0, 1, 2});

        const float window = view.window_depth(view.image_point({0, 0, -5}));
        CHECK(window == doctest::Approx(0.5454545));
        std::vector<float> depth(256 * 256, view.window_depth(view.image_point({1, 2, -5}))), min(64), max(64);
        depth[128 * 256 + 128] = view.window_depth({128.5, 128.5, 5});
        REQUIRE(reduce_depth(view, {.depth = depth}, {min, max}));
        const auto tile = view.tile_at(view.image_point({1, 2, -5}));
        for (const int at : {4 * 8 + 4, tile->y * 8 + tile->x}) {
            CHECK(min[static_cast<std::size_t>(at)] <= 5);
            CHECK(max[static_cast<std::size_t>(at)] >= 5);
        }
        REQUIRE(reduce_depth(*View::from_projection(matrix, {1, 1}, {.clip_depth = clip_depth}),
                             {.depth = {&window, 1}}, {min, max}));
        CHECK(min[0] == doctest::Approx(5).epsilon(1e-5));
        CHECK(max[0] == doctest::Approx(5).epsilon(1e-5));
    }
}

TEST_CASE("an oblique near plane: no light is missed, and by the view of the old planes many are") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1), distance(0.05, 3), depth(0.5, 30);
    const glm::dmat4 projections[] = {glm::perspective(std::acos(0.0), 1.0, 1.0, 10.0),
                                      glm::frustum(-0.5, 1.5, -1.0, 0.7, 1.0, 10.0),
                                      glm::frustumLH_NO(-1.0, 1.0, -0.3, 0.9, 0.5, 20.0),
                                      glm::ortho(-6.0, 6.0, -5.0, 7.0, 1.0, 10.0)};
    std::size_t drawn = 0, missed = 0, missed_by_original = 0;
    for (int round = 0; round < 80; ++round) {
        const glm::dmat4& projection = projections[round % 4];
        const double forward = projection[2][3] > 0 ? 1 : -1;
        const auto any_vector = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
        const glm::dvec3 normal(unit(random), unit(random), forward * (0.1 + distance(random)));
        std::vector<Sphere> lights;
        for (int light = 0; light < 40; ++light) {
            const double away = depth(random);
            const glm::vec3 centre(unit(random) * away, unit(random) * away, forward * away);
            lights.push_back({centre.x, centre.y, centre.z, static_cast<float>(distance(random) / 2)});
        }
        const glm::dmat4 oblique = with_near_plane(projection, glm::dvec4(normal, -distance(random)));
        const auto listed = test::lists(*View::from_projection(oblique, {256, 256}), lights),
                   original = test::lists(*View::from_projection(projection, {256, 256}), lights);
        for (std::uint32_t id = 0; id < lights.size(); ++id)
            for (int i = 0; i < 50; ++i) {  // points inside of the sphere
                const glm::dvec3 centre(lights[id].x, lights[id].y, lights[id].z), aside = glm::normalize(any_vector());
                const glm::dvec3 point = centre + aside * (0.99 * std::fabs(unit(random)) * lights[id].radius);
                const glm::dvec4 clip = oblique * glm::dvec4(point, 1);
                if (!(clip.w > 0 && glm::all(glm::lessThan(glm::abs(glm::dvec3(clip)), glm::dvec3(clip.w))))) continue;
                const auto tile_of = [&](double c) { return static_cast<std::size_t>((c / clip.w + 1) * 4); };
                const std::size_t tile = 8 * tile_of(clip.y) + tile_of(clip.x);
                ++drawn;
                missed += !std::binary_search(listed[tile].begin(), listed[tile].end(), id);
                missed_by_original += !std::binary_search(original[tile].begin(), original[tile].end(), id);
            }
    }
    CHECK(drawn > 40000);
    CHECK(missed == 0);
    CHECK(missed_by_original > drawn / 10);
}
