// Declares what the code blocks in docs/ use without defining it: functions and objects of the reader's renderer.
#pragma once

#include <lightbin/lightbin.hpp>

#include <lightbin/advise.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/shader.hpp>
#include <lightbin/shader_cull.hpp>

#include <epoxy/gl.h>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <thread>
#include <vector>

struct Lamp {
    glm::vec3 position, direction;
    float range, candela, cos_outer;
    std::uint32_t mask;
};

struct StreetLamp {
    glm::dvec3 position;
    float range;
};

struct Camera {
    glm::mat4 projection, world_to_view;
    lightbin::ImageSize size;
};

struct Decal {
    glm::mat4 to_world;
};

struct ThreadPool {
    std::size_t size() const;
    template <class Body> void parallel_for(std::size_t count, const Body& body);
};

int fail(const std::string& message);
int grow(std::size_t ranges, std::size_t ids);
void warn(const std::string& message);
void allot_shadow_map(std::uint32_t id, float pixels);
template <class... Arguments> void upload(Arguments&&... arguments);
void bind_buffers(int ranges, int ids);
template <class... Arguments> void allocate(Arguments&&... arguments);
void compile_compute(const std::string& text);
void dispatch(std::uint32_t x, std::uint32_t y);
void storage_barrier();

extern const glm::mat4 projection, view_matrix;
extern const float numbers[16];
extern const lightbin::Result<lightbin::View> view;
extern const lightbin::Result<lightbin::LightGrid<std::uint32_t>> grid;
extern lightbin::Binner<> binner;
extern std::FILE* const file;
extern const std::vector<glm::vec4> spheres;
extern const std::vector<Lamp> lamps;
extern const std::vector<StreetLamp> street_lamps;
extern const glm::dvec3 eye_position;
extern const std::vector<Decal> decals;
struct Eye {
    lightbin::View view;
    glm::mat4 world_to_view;
};
extern const Eye eyes[2];
extern const lightbin::Result<lightbin::LightGrid<std::uint32_t>> left_grid, right_grid;
lightbin::Sphere to_sphere(const Lamp& lamp);
lightbin::Box to_box(const Decal& decal);
extern const Lamp lamp;
extern const std::vector<float> depth_buffer;
extern const float white, distance, range;
extern const std::uint32_t this_view_shows;
extern ThreadPool pool;
extern const std::uint32_t room;

extern std::span<lightbin::ListRange> mapped_ranges;
extern std::span<std::uint32_t> mapped_ids;
extern int mask_buffer, slice_buffer, tile_buffer, list_buffer, constant_buffer, footprints_buffer, z_bounds_buffer;
extern const std::string vertex_text, your_fragment_text, your_pixel_shader, your_wgsl;
template <class... Arguments> void add_compute_pass(Arguments&&... arguments);
GLuint link(const std::string& vertex, const std::string& fragment);
extern GLuint program, ranges_buffer, ids_buffer, ranges_texture, ids_texture;

// Vulkan's, as far as the guide calls it.
using VkCommandBuffer = struct VkCommandBuffer_T*;
using VkPipelineLayout = struct VkPipelineLayout_T*;
constexpr std::uint32_t VK_SHADER_STAGE_FRAGMENT_BIT = 16;
void vkCmdPushConstants(VkCommandBuffer, VkPipelineLayout, std::uint32_t, std::uint32_t, std::uint32_t, const void*);
extern const VkCommandBuffer commands;
extern const VkPipelineLayout layout;
std::vector<std::uint32_t> compile_spirv(const std::string& text);
