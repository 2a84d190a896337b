// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <lightbin/lights.hpp>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error(what);
}

// Indices in a file can be anything.
template <class T> const T& at(const std::vector<T>& items, int index, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= items.size())
        fail("it refers to " + std::string(what) + " " + std::to_string(index) + ", which is not there");
    return items[static_cast<std::size_t>(index)];
}

// The elements of an accessor, known to lie inside their buffer.
struct Elements {
    const unsigned char* data;
    std::size_t count;
    std::size_t stride;
    int component_type;
    bool normalized;

    template <class T> T get(std::size_t i) const {
        T value;
        std::memcpy(&value, data + i * stride, sizeof value);
        return value;
    }

    std::uint32_t index(std::size_t i) const {
        switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return get<std::uint8_t>(i);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return get<std::uint16_t>(i);
        default:
            return get<std::uint32_t>(i);
        }
    }

    // Three numbers: floats, or the integers of KHR_mesh_quantization.
    glm::dvec3 vector(std::size_t i) const {
        switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return of_integers<std::int8_t>(i);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return of_integers<std::uint8_t>(i);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return of_integers<std::int16_t>(i);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return of_integers<std::uint16_t>(i);
        default:
            return glm::dvec3(get<glm::vec3>(i));
        }
    }

private:
    template <class T> glm::dvec3 of_integers(std::size_t i) const {
        const glm::dvec3 v(get<glm::vec<3, T>>(i));
        return normalized ? glm::max(v / static_cast<double>(std::numeric_limits<T>::max()), -1.0) : v;
    }
};

Elements elements(const tinygltf::Model& model, int accessor_index, int type,
                  std::initializer_list<int> component_types) {
    const auto& accessor = at(model.accessors, accessor_index, "accessor");
    const std::string name = "accessor " + std::to_string(accessor_index);
    if (accessor.type != type || std::find(component_types.begin(), component_types.end(),
                                           accessor.componentType) == component_types.end())
        fail(name + " has an unexpected type");
    if (accessor.sparse.isSparse) fail(name + " is sparse, which this program does not read");

    const auto& view = at(model.bufferViews, accessor.bufferView, "buffer view");
    const auto& bytes = at(model.buffers, view.buffer, "buffer").data;
    const int stride = accessor.ByteStride(view);
    const std::size_t size =
        static_cast<std::size_t>(
            tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType))) *
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    // In steps that cannot overflow, whatever the file says.
    bool inside = stride >= static_cast<int>(size) && view.byteOffset <= bytes.size() &&
                  view.byteLength <= bytes.size() - view.byteOffset && accessor.byteOffset <= view.byteLength;
    if (inside && accessor.count > 0) {
        const std::size_t room = view.byteLength - accessor.byteOffset;
        inside = size <= room && accessor.count - 1 <= (room - size) / static_cast<std::size_t>(stride);
    }
    if (!inside) fail(name + " reaches past the end of its buffer");
    return {bytes.data() + view.byteOffset + accessor.byteOffset, accessor.count,
            static_cast<std::size_t>(stride), accessor.componentType, accessor.normalized};
}

Elements vectors(const tinygltf::Model& model, int accessor_index) {
    return elements(model, accessor_index, TINYGLTF_TYPE_VEC3,
                    {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_COMPONENT_TYPE_BYTE,
                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_SHORT,
                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT});
}

// Vertex numbers of the primitive's triangles, whatever its mode and indices; empty for points and lines.
std::vector<std::uint32_t> triangle_corners(const tinygltf::Model& model,
                                            const tinygltf::Primitive& primitive, std::size_t vertex_count) {
    std::vector<std::uint32_t> order;
    if (primitive.indices >= 0) {
        const Elements indices =
            elements(model, primitive.indices, TINYGLTF_TYPE_SCALAR,
                     {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT});
        order.resize(indices.count);
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = indices.index(i);
            if (order[i] >= vertex_count)
                fail("an index refers to vertex " + std::to_string(order[i]) + ", which is not there");
        }
    } else {
        order.resize(vertex_count);
        for (std::size_t i = 0; i < order.size(); ++i)
            order[i] = static_cast<std::uint32_t>(i);
    }

    const std::size_t n = order.size();
    switch (primitive.mode) {
    case -1:  // absent: triangles
    case TINYGLTF_MODE_TRIANGLES:
        order.resize(n / 3 * 3);
        return order;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
    case TINYGLTF_MODE_TRIANGLE_FAN: {
        const bool fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
        std::vector<std::uint32_t> corners;
        for (std::size_t i = 0; i + 2 < n; ++i) {
            const std::size_t odd = i % 2;
            if (fan)
                corners.insert(corners.end(), {order[i + 1], order[i + 2], order[0]});
            else  // every second triangle of a strip runs the other way round
                corners.insert(corners.end(), {order[i], order[i + 1 + odd], order[i + 2 - odd]});
        }
        return corners;
    }
    default:
        return {};
    }
}

class Loader {
public:
    Loader(const tinygltf::Model& model, float cutoff)
        : model_(model), cutoff_(cutoff), seen_(model.nodes.size()) {}

    Scene load() {
        if (model_.scenes.empty()) fail("it has no scene");
        for (const int root : at(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes)
            add_node(root, glm::dmat4(1));

        if (scene_.lights.empty()) fail("it has no point or spot lights (KHR_lights_punctual)");
        if (scene_.triangles.empty()) fail("it has no triangles");
        if (scene_.cameras.empty()) {
            scene_.cameras.push_back(framing_camera(scene_.triangles));
            note("the file has no camera: made one that has the whole scene in sight");
        }
        if (skipped_primitives_ > 0)
            note(counted(skipped_primitives_, "primitive") + " of points or lines left out");
        if (without_range_ > 0 && cutoff_ > 0)
            note(counted(without_range_, "light") + " without a range: cut off at " + number(cutoff_) +
                 " lux (--cutoff)");
        else if (without_range_ > 0)
            note(counted(without_range_, "light") +
                 " without a range: infinite, so in every list (--cutoff 0)");
        if (!scene_.suns.empty())
            note(counted(scene_.suns.size(), "directional light") +
                 ": in no list, every fragment is shaded with them");
        return std::move(scene_);
    }

private:
    const tinygltf::Model& model_;
    float cutoff_;
    std::vector<bool> seen_;  // nodes, to survive a graph that is no tree
    Scene scene_;
    std::size_t skipped_primitives_ = 0;
    std::size_t without_range_ = 0;

    void note(std::string text) { scene_.notes.push_back(std::move(text)); }

    static std::string number(float value) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%g", static_cast<double>(value));
        return text.data();
    }

    static glm::dmat4 local_transform(const tinygltf::Node& node) {
        if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
        glm::dmat4 m(1);
        if (node.translation.size() == 3) m = glm::translate(m, glm::make_vec3(node.translation.data()));
        if (node.rotation.size() == 4) {
            const auto& q = node.rotation;  // x, y, z, w in the file
            m *= glm::mat4_cast(glm::normalize(glm::dquat(q[3], q[0], q[1], q[2])));
        }
        if (node.scale.size() == 3) m = glm::scale(m, glm::make_vec3(node.scale.data()));
        return m;
    }

    void add_node(int root, const glm::dmat4& root_transform) {
        struct Work {
            int node;
            glm::dmat4 parent;
        };
        std::vector<Work> stack{{root, root_transform}};  // no recursion: a file may nest as deep as it likes
        while (!stack.empty()) {
            const Work work = stack.back();
            stack.pop_back();
            const auto& node = at(model_.nodes, work.node, "node");
            const auto slot = static_cast<std::size_t>(work.node);
            if (seen_[slot]) fail("node " + std::to_string(work.node) + " has more than one parent");
            seen_[slot] = true;

            const glm::dmat4 to_world = work.parent * local_transform(node);
            if (node.mesh >= 0)
                for (const auto& primitive : at(model_.meshes, node.mesh, "mesh").primitives)
                    add_primitive(primitive, to_world);
            if (node.camera >= 0) add_camera(node, to_world);
            if (const auto found = node.extensions.find("KHR_lights_punctual");
                found != node.extensions.end()) {
                if (!found->second.IsObject() || !found->second.Has("light"))
                    fail("node " + std::to_string(work.node) + " has a light without a number");
                add_light(found->second.Get("light").GetNumberAsInt(), to_world);
            }
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                stack.push_back({*child, to_world});
        }
    }

    void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& to_world) {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return;  // the specification: draw nothing
        const Elements positions = vectors(model_, position->second);
        const auto normal = primitive.attributes.find("NORMAL");
        const bool flat = normal == primitive.attributes.end();
        Elements normals{};
        if (!flat) {
            normals = vectors(model_, normal->second);
            if (normals.count < positions.count) fail("a mesh has fewer normals than positions");
        }
        auto corners = triangle_corners(model_, primitive, positions.count);
        if (corners.empty() && positions.count > 0) ++skipped_primitives_;

        glm::vec3 colour(1);
        if (primitive.material >= 0) {
            const auto& factor =
                at(model_.materials, primitive.material, "material").pbrMetallicRoughness.baseColorFactor;
            if (factor.size() >= 3) colour = glm::vec3(glm::make_vec3(factor.data()));
        }

        const glm::dmat3 turn(to_world);
        const glm::dmat3 normals_to_world = glm::transpose(glm::inverse(turn));
        const bool mirrored =
            glm::determinant(turn) < 0;  // turns the triangles inside out, so turn them back
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            if (mirrored) std::swap(corners[i + 1], corners[i + 2]);
            std::array<glm::dvec3, 3> p;
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = glm::dvec3(to_world * glm::dvec4(positions.vector(corners[i + k]), 1.0));
            const glm::dvec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
            if (!(glm::length(face) > 0)) continue;  // no area, no normal, no pixel
            for (std::size_t k = 0; k < 3; ++k) {
                glm::dvec3 n = face;
                if (!flat) {
                    const glm::dvec3 given = normals_to_world * normals.vector(corners[i + k]);
                    if (glm::length(given) > 0) n = given;
                }
                scene_.triangles.push_back({glm::vec3(p[k]), glm::vec3(glm::normalize(n)), colour});
            }
        }
    }

    // Cameras and lights take a node's place and direction, not its scale.
    static glm::dvec3 place(const glm::dmat4& to_world) { return glm::dvec3(to_world[3]); }
    static glm::dvec3 forward(const glm::dmat4& to_world) { return -glm::normalize(glm::dvec3(to_world[2])); }

    void add_camera(const tinygltf::Node& node, const glm::dmat4& to_world) {
        const auto& source = at(model_.cameras, node.camera, "camera");
        Camera camera;
        camera.name = !node.name.empty() ? node.name : source.name;
        const glm::dvec3 up = glm::normalize(glm::dvec3(to_world[1]));
        camera.to_world = glm::inverse(glm::lookAt(place(to_world), place(to_world) + forward(to_world), up));
        double far = 0;
        if (source.type == "orthographic") {
            camera.orthographic = true;
            camera.height = 2 * source.orthographic.ymag;
            camera.near = source.orthographic.znear;
            far = source.orthographic.zfar;
        } else {
            camera.height = source.perspective.yfov;
            camera.near = source.perspective.znear;
            far = source.perspective.zfar;
        }
        if (far > 0) camera.far = far;  // absent: infinite
        scene_.cameras.push_back(camera);
    }

    void add_light(int index, const glm::dmat4& to_world) {
        const auto& source = at(model_.lights, index, "light");
        glm::vec3 intensity(static_cast<float>(source.intensity));
        if (source.color.size() >= 3) intensity *= glm::vec3(glm::make_vec3(source.color.data()));
        if (source.type == "directional") {
            scene_.suns.push_back({glm::vec3(forward(to_world)), intensity});
            return;
        }
        Light light;
        light.position = glm::vec3(place(to_world));
        light.intensity = intensity;
        light.range = static_cast<float>(source.range);
        if (!(light.range > 0)) {  // absent: infinite
            ++without_range_;
            light.range = lightbin::light_range(std::max({intensity.x, intensity.y, intensity.z}), cutoff_);
        }
        if (source.type == "spot") {
            light.spot = true;
            light.direction = glm::vec3(forward(to_world));
            light.cos_inner = static_cast<float>(std::cos(source.spot.innerConeAngle));
            light.cos_outer = static_cast<float>(std::cos(source.spot.outerConeAngle));
        }
        scene_.lights.push_back(light);
    }
};

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

}  // namespace

Scene read_glb(std::span<const unsigned char> bytes, const std::string& path, float cutoff) {
    try {
        tinygltf::TinyGLTF gltf;
        gltf.SetImageLoader([](auto...) { return true; },
                            nullptr);  // no textures here, so no need to decode them
        tinygltf::Model model;
        std::string error;
        std::string warning;
        const std::string folder =
            path.find('/') == std::string::npos ? "." : path.substr(0, path.rfind('/'));
        if (!gltf.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(),
                                       static_cast<unsigned>(bytes.size()), folder))
            fail("not a readable glTF binary: " + first_line(error));
        for (const auto& extension : model.extensionsRequired)
            if (extension != "KHR_lights_punctual" && extension != "KHR_mesh_quantization")
                fail("it needs " + extension + ", which this program does not read");
        Scene scene = Loader(model, cutoff).load();
        scene.name = path.substr(path.rfind('/') + 1);
        return scene;
    } catch (const std::bad_alloc&) {
        throw;  // not the file's fault
    } catch (const std::exception& problem) {
        fail("'" + path + "': " + problem.what());
    }
}

Scene load_glb(const std::string& path, float cutoff) {
    std::ifstream file(path, std::ios::binary);
    if (!file) fail("cannot open '" + path + "'");
    std::vector<char> bytes;
    try {
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    } catch (const std::ios_base::failure& problem) {
        fail("'" + path + "': " + problem.what());
    }
    return read_glb({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, path, cutoff);
}
