// SPDX-License-Identifier: MIT
// Tests what the example tiled_forward reads from a .glb file.
#include "glb.hpp"

#include "scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace {

Scene load(const std::string& bytes, float cutoff = 0.05f) {
    write_file("load_glb_test.glb", bytes);
    return load_glb("load_glb_test.glb", cutoff);
}

std::string refusal(const std::string& bytes) {
    try {
        load(bytes);
    } catch (const std::exception& problem) {
        return problem.what();
    }
    return "";
}

void check_near(const glm::vec3& a, const glm::vec3& b) {
    CHECK(glm::length(a - b) < 1e-5f);
}

bool mentions(const Scene& scene, const std::string& text) {
    return std::any_of(scene.notes.begin(), scene.notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("every kind of primitive gives the triangles of its square") {
    const Scene scene = load(everything_glb());
    // The node with mesh 0 is drawn as four squares, then come meshes 2 (its child) and 1, with two triangles each.
    REQUIRE(scene.triangles.size() == 6 * 6);
    for (std::size_t square = 0; square < 4; ++square) {
        CAPTURE(square);
        double area = 0;
        for (std::size_t i = 6 * square; i < 6 * square + 6; i += 3) {
            const Vertex* v = &scene.triangles[i];
            area += static_cast<double>(glm::length(
                        glm::cross(v[1].position - v[0].position, v[2].position - v[0].position))) /
                    2;
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(std::abs(v[k].position.x) == doctest::Approx(10));
                CHECK(v[k].position.z == doctest::Approx(-20));
                check_near(v[k].normal, {0, 0, 1});  // flat: the file has none
                check_near(v[k].colour, square == 0 ? glm::vec3(0.5f, 0.25f, 1) : glm::vec3(1));
            }
        }
        CHECK(area == doctest::Approx(400));
    }
    CHECK(mentions(scene, "1 primitive"));  // of points
}

TEST_CASE("a node's transform is that of its parents and its own") {
    const Scene scene = load(everything_glb());
    // Node 3, at (0, 1, 2) in a parent with scale 2, is turned by 90 degrees about y (z becomes x) and moved by (0, 0,
    // -10).
    for (std::size_t i = 24; i < 30; ++i) {
        const Vertex& v = scene.triangles[i];
        CHECK(v.position.x == doctest::Approx(4));
        CHECK(std::abs(v.position.y - 2) == doctest::Approx(2));
        CHECK(std::abs(v.position.z + 10) == doctest::Approx(2));
        check_near(v.normal, {1, 0, 0});
    }
    check_near(scene.lights[0].position, {2, 0, -10});
}

TEST_CASE("given normals are kept, and a mirrored mesh is not turned inside out") {
    const Scene scene = load(everything_glb());
    for (std::size_t i = 30; i < 36; i += 3) {
        const Vertex* v = &scene.triangles[i];
        check_near(v[0].normal, {0, 0.6f, 0.8f});
        CHECK(glm::cross(v[1].position - v[0].position, v[2].position - v[0].position).z > 0);
    }
}

TEST_CASE("positions and normals may be integers, as they are or as shares of the largest") {
    // A triangle (2, 0, -4), (12, 0, -4), (2, 10, -4), in forms with different scales and moves of nodes.
    struct Form {
        const char *type, *scale, *translation;
        std::string corners;
        int stride;
    };
    const std::vector<Form> forms = {
        {"5123, \"normalized\": true", "10", "[2, 0, -4]",
         bytes_of(std::vector<std::uint16_t>{0, 0, 0, 9, 65535, 0, 0, 9, 0, 65535, 0, 9}), 8},
        {"5122", "0.001", "[22, 20, -4]",
         bytes_of(
             std::vector<std::int16_t>{-20000, -20000, 0, 9, -10000, -20000, 0, 9, -20000, -10000, 0, 9}),
         8}};
    for (const Form& form : forms) {
        CAPTURE(std::string(form.type));
        const std::string size = std::to_string(form.corners.size()), scale = form.scale;
        const std::string json = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "nodes": [
  {"mesh": 0, "translation": )" + std::string(form.translation) +
                                 ", \"scale\": [" + scale + ", " + scale + ", " + scale +
                                 R"(]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
"accessors": [{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": )" +
                                 form.type + R"(},
  {"bufferView": 1, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": )" +
                                 size + ", \"byteStride\": " + std::to_string(form.stride) +
                                 R"(}, {"buffer": 0, "byteLength": 12, "byteStride": 4, "byteOffset": )" +
                                 size +
                                 R"(}],
"buffers": [{"byteLength": )" + std::to_string(form.corners.size() + 12) +
                                 R"(}], "extensionsRequired": ["KHR_mesh_quantization"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "range": 6}]}}})";
        const std::vector<std::int8_t> normals = {0, 0, 127, 9, 0, 0, -127, 9, 0, 0, 127, 9};
        const Scene scene = load(glb(json, form.corners + bytes_of(normals)));
        REQUIRE(scene.triangles.size() == 3);
        check_near(scene.triangles[0].position, {2, 0, -4});
        check_near(scene.triangles[1].position, {12, 0, -4});
        check_near(scene.triangles[2].position, {2, 10, -4});
        check_near(scene.triangles[1].normal, {0, 0, -1});
    }
}

TEST_CASE("lights: range, intensity, cone, direction") {
    const Scene scene = load(everything_glb());
    REQUIRE(scene.lights.size() == 3);
    CHECK(scene.lights[0].range == 6);  // a node's scale does not touch it
    check_near(scene.lights[0].intensity, {40, 20, 10});
    CHECK(scene.lights[1].range == doctest::Approx(20));  // 20 candela give 0.05 lux at 20 metres
    check_near(scene.lights[1].position, {-2, 3, -10});
    CHECK(mentions(scene, "1 light without a range"));

    CHECK(scene.lights[2].spot);
    check_near(scene.lights[2].direction, {0, -1, 0});
    CHECK(scene.lights[2].cos_inner == doctest::Approx(std::cos(0.3)));
    CHECK(scene.lights[2].cos_outer == doctest::Approx(std::cos(0.6)));

    REQUIRE(scene.suns.size() == 1);
    check_near(scene.suns[0].direction, {0, -1, 0});
    check_near(scene.suns[0].illuminance, glm::vec3(0.1f));
    CHECK(mentions(scene, "1 directional light"));

    CHECK(std::isinf(load(everything_glb(), 0).lights[1].range));
}

TEST_CASE("cameras: both kinds, an absent far plane, none at all") {
    const Scene scene = load(everything_glb());
    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[0].name == "front");
    CHECK_FALSE(scene.cameras[0].orthographic);
    CHECK(scene.cameras[0].height == 1.0);
    CHECK(std::isinf(scene.cameras[0].far));
    check_near(glm::vec3(scene.cameras[0].to_world[3]), {0, 1, 5});
    CHECK(scene.cameras[1].orthographic);
    CHECK(scene.cameras[1].height == 12);
    CHECK(scene.cameras[1].far == 60);

    const Scene none = load(with(with(everything_glb(), "\"camera\": 0,", ""), "\"camera\": 1,", ""));
    REQUIRE(none.cameras.size() == 1);
    CHECK(mentions(none, "no camera"));
    for (const Vertex& vertex : none.triangles) {  // all of it is in sight
        const glm::dvec3 p(glm::inverse(none.cameras[0].to_world) * glm::dvec4(vertex.position, 1.0));
        CHECK(-p.z > none.cameras[0].near);
        CHECK(std::abs(p.y) < -p.z * std::tan(none.cameras[0].height / 2));
    }
}

TEST_CASE("a file that is not right is refused in one line that names it") {
    const std::string good = everything_glb();
    const std::string prefix = "'load_glb_test.glb': ";
    const auto refused = [&](const std::string& bytes, const std::string& reason) {
        const std::string text = refusal(bytes);
        CAPTURE(text);
        CHECK(text.substr(0, prefix.size()) == prefix);
        CHECK(text.find(reason) != std::string::npos);
        CHECK(text.find('\n') == std::string::npos);
    };
    CHECK(refusal(good).empty());
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{10}, std::size_t{30}, good.size() / 2, good.size() - 8})
        refused(good.substr(0, size), "not a readable glTF binary");
    refused(with(good, "\"asset\":", "\"asset\";"), "not a readable glTF binary");
    refused(with(good, "[0, 1, 2, 5]", "[0,1,2,77]"), "node 77");
    refused(with(good, "\"children\": [3, 4]", "\"children\": [1, 4]"), "more than one parent");
    refused(with(good, "\"children\": [3, 4]", "\"children\": [0, 4]"), "more than one parent");
    refused(with(good, "\"mesh\": 2", "\"mesh\": 9"), "mesh 9");
    refused(with(good, "{\"light\": 1}", "{\"light\": 8}"), "light 8");
    refused(with(good, "{\"light\": 1}", "{\"night\": 1}"), "light without a number");
    refused(with(good, "\"indices\": 3", "\"indices\": 0"), "unexpected type");
    refused(with(good, "\"POSITION\": 1", "\"POSITION\": 3"), "unexpected type");
    refused(with(good, "\"POSITION\": 1", "\"POSITION\": 8"), "accessor 8");
    refused(with(good, "\"count\": 4", "\"count\":40"), "past the end");
    refused(with(good, "[0, 1, 2, 5]", "[0, 2]"), "no point or spot lights");
    refused(with(good, "[0, 1, 2, 5]", "[5]"), "no triangles");
    refused(with(good, "\"extensionsUsed\": [\"KHR_lights_punctual\"]",
                 "\"extensionsRequired\": [\"KHR_x_y_z\"]"),
            "KHR_x_y_z");
}
