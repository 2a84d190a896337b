// SPDX-License-Identifier: MIT
#include "renderer.hpp"

#include "gl_program.hpp"
#include "shaders.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

GLenum target_of(lightbin::ShaderResource resource) {
    return resource == lightbin::ShaderResource::texture_2d ? GL_TEXTURE_2D : GL_TEXTURE_BUFFER;
}

lightbin::Slicing slicing_of(const FrameSettings& settings) {
    return settings.depth == DepthUse::z_bins     ? lightbin::Slicing::z_bins
           : settings.depth == DepthUse::clusters ? lightbin::Slicing::clusters
                                                  : lightbin::Slicing::none;
}

DepthMethod method_of(const FrameSettings& settings) {
    return settings.depth == DepthUse::z_bins     ? DepthMethod::z_bins
           : settings.depth == DepthUse::clusters ? DepthMethod::clusters
           : settings.has_z_bounds()              ? DepthMethod::z_bounds
                                                  : DepthMethod::none;
}

// Mesa's software renderer ends a shader's loops after 65,535 rounds, and says nothing.
void check_loop(std::size_t lights) {
    if (lights > 65000)
        throw std::runtime_error(
            "a fragment would loop over " + std::to_string(lights) +
            " lights, and some drivers end a loop after 65,535: use fewer lights or smaller tiles");
}

}  // namespace

// Milliseconds since the last call, with OpenGL's work done.
class Renderer::Stopwatch {
public:
    double lap() {
        glFinish();
        const auto now = std::chrono::steady_clock::now();
        const double milliseconds = std::chrono::duration<double, std::milli>(now - start_).count();
        start_ = now;
        return milliseconds;
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The frame, from top to bottom.
FrameReport Renderer::draw(const Camera& camera, const FrameSettings& settings) {
    FrameReport report;
    Stopwatch watch;
    start(camera, settings);
    watch.lap();

    // 1. The view: the projection matrix, the viewport and the tile size fix the grid of tiles.
    const int part = settings.stale_size ? 2 : 1;
    const lightbin::View view = value_of(lightbin::View::from_projection(
        projection_, {settings.width / part, settings.height / part}, {.tile_size = settings.tile_size}));

    // 2. Depth alone, and from it the depths between which each tile has anything to light.
    const bool pre_pass = settings.depth == DepthUse::pre_pass;
    if (pre_pass) draw_depth();
    grid_ = lightbin::grid_constants(view);
    shader_view_ = lightbin::view_constants(view);

    // 3. The lists: which lights can reach which tile. In the end they are in buffers on the GPU.
    const Listed listed = settings.gpu_build ? list_on_gpu(view, settings, watch, report)
                                             : list_on_cpu(view, settings, watch, report);

    // 4. The picture.
    check_loop(listed.longest);
    if (settings.checks.lists) check_loop(binned_.listed_count());
    draw_triangles(tiled_program(settings), true, settings);
    report.milliseconds.draw = watch.lap();

    report.tiles_x = view.tiles_x();
    report.tiles_y = view.tiles_y();
    if (settings.count_evaluations) report.evaluations_per_pixel = count_evaluations(settings, listed);
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw std::runtime_error("OpenGL reports error " + std::to_string(error));
    return report;
}

// By a Binner, and then uploaded.
Renderer::Listed Renderer::list_on_cpu(const lightbin::View& view, const FrameSettings& settings,
                                       Stopwatch& watch, FrameReport& report) {
    const bool bounded = settings.has_z_bounds();
    // OpenGL ES reads no depths back, and no OpenGL those of several samples.
    const bool on_gpu = settings.gpu_reduction || glsl_ < 330 || settings.samples > 1;
    if (bounded && !on_gpu) {
        depth_buffer_.resize(static_cast<std::size_t>(settings.width) *
                             static_cast<std::size_t>(settings.height));
        glReadPixels(0, 0, settings.width, settings.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                     depth_buffer_.data());
    }
    report.milliseconds.pre_pass = watch.lap();

    // Opaque surfaces end before the sky, glass is lit there too: its maximum counts the background.
    const bool glass = shows_glass(settings);
    if (bounded) {
        min_depth_.resize(settings.z_bounds == ZBoundsUse::both ? view.tile_count() : 0);
        max_depth_.resize(view.tile_count());
        glass_max_.resize(glass ? view.tile_count() : 0);
        const auto reduce = [&](bool skip_background, std::span<float> min, std::span<float> max) {
            if (on_gpu)
                reduce_on_gpu(view, skip_background, min, max);
            else
                static_cast<void>(value_of(lightbin::reduce_depth(
                    view, {.depth = depth_buffer_, .skip_background = skip_background}, {.min = min, .max = max})));
        };
        reduce(true, min_depth_, max_depth_);
        if (glass) reduce(false, {}, glass_max_);
    }
    report.milliseconds.reduce = watch.lap();

    const auto [opaque, transparent] = binned_.bin(
        view, {.method = method_of(settings), .glass = glass, .dropped_light = settings.dropped_light},
        {.min = min_depth_, .max = max_depth_}, {.max = glass_max_});
    slices_ = binned_.slices();
    report.milliseconds.bin = watch.lap();

    upload_lights();
    upload_lists(opaque_lists_, opaque);
    if (glass) upload_lists(transparent_lists_, transparent);
    if (slices_) {
        const std::vector<std::uint32_t> words = lightbin::shader_slices(*slices_);
        const auto bins = std::as_bytes(opaque.ranks().bins);
        const int width = static_cast<int>(list_binding_.width);
        upload(slices_buffer_, words.data(), 4 * words.size(), width, "slices");
        upload(bins_buffer_, bins.data(), bins.size(), width, "bins");
    }
    report.milliseconds.upload = watch.lap();

    const lightbin::LightCounts& counts = opaque.light_counts();
    report.lights_in_view = counts.lights - counts.culled - counts.rejected;
    report.rejected = counts.rejected;
    report.entries = opaque.ids().size();
    report.longest_list = longest_list(opaque);
    report.transparent_entries = glass ? transparent.ids().size() : 0;
    const bool z_bins = settings.depth == DepthUse::z_bins;
    const auto evaluations = [this, z_bins, grid = opaque](int x, int y, float depth) {
        const int slice = slices_ ? slices_->slice_at(depth) : 0;
        const auto list = grid.lights_in(x, y, grid.slices() > 1 ? slice : 0);
        if (!z_bins) return list.size();
        return lightbin::lights_of_bin(list, grid.ranks().bins[static_cast<std::size_t>(slice)]).size();
    };
    return {evaluations, glass ? longest_list(transparent) : report.longest_list};  // no shorter than the opaque one
}

// By compute shaders, where they are read. Lights and depths don't come back to the CPU.
Renderer::Listed Renderer::list_on_gpu(const lightbin::View& view, const FrameSettings& settings,
                                       Stopwatch& watch, FrameReport& report) {
    if (list_binding_.resource != lightbin::ShaderResource::storage_buffer)
        throw std::runtime_error("lists are made on the GPU by OpenGL 4.3 or ES 3.1, not with GLSL " +
                                 std::to_string(glsl_));
    const bool bounded = settings.has_z_bounds(), glass = shows_glass(settings);
    report.milliseconds.pre_pass = watch.lap();
    if (bounded) culled_.reduce(view, frame_buffer_, true);
    report.milliseconds.reduce = watch.lap();
    upload_lights();
    culled_.upload(binned_.as_spots(settings.dropped_light));
    report.milliseconds.upload = watch.lap();

    CulledLights::Lists lists;
    slices_.reset();
    if (bounded) lists = {true, settings.z_bounds == ZBoundsUse::max};
    if (settings.depth == DepthUse::clusters) {
        slices_ = slices_for(DepthMethod::clusters, view.orthographic(), binned_.listed());
        lists = {true, false, &*slices_};
        const std::vector<std::uint32_t> words = lightbin::shader_slices(*slices_);
        upload(slices_buffer_, words.data(), 4 * words.size(), static_cast<int>(list_binding_.width),
               "slices");
    }
    const auto made = culled_.build(view, lists, opaque_lists_.tiles.buffer, opaque_lists_.indices.buffer);
    CulledLights::Made for_glass;
    if (glass) {  // it may stand anywhere before the opaque surfaces
        lists.max_only = bounded;
        if (bounded) culled_.reduce(view, frame_buffer_, false);
        for_glass =
            culled_.build(view, lists, transparent_lists_.tiles.buffer, transparent_lists_.indices.buffer);
    }
    report.milliseconds.bin = watch.lap();

    const auto longest = [](const CulledLights::Made& of) {
        std::uint32_t most = 0;
        for (const lightbin::ListRange& range : of.ranges)
            most = std::max(most, range.count);
        return most;
    };
    report.lights_in_view = made.totals.visible;
    report.rejected = made.totals.rejected;
    report.entries = made.totals.entries;
    report.longest_list = longest(made);
    report.transparent_entries = glass ? for_glass.totals.entries : 0;
    const auto evaluations = [this, columns = view.tiles_x(), rows = view.tiles_y(),
                              ranges = made.ranges](int x, int y, float depth) {
        const int slice = slices_ ? slices_->slice_at(depth) : 0;
        return std::size_t{ranges[static_cast<std::size_t>((slice * rows + y) * columns + x)].count};
    };
    return {evaluations, glass ? longest(for_glass) : report.longest_list};
}

void Renderer::draw_every_light(const Camera& camera, const FrameSettings& settings) {
    check_loop(binned_.listed_count());
    start(camera, settings);
    if (settings.depth == DepthUse::pre_pass) draw_depth();
    upload_lights();
    draw_triangles(brute_force_program_, false, settings);
}

// Counted for each pixel, from its depth, by the lists themselves.
double Renderer::count_evaluations(const FrameSettings& settings, const Listed& listed) {
    const lightbin::View pixels = value_of(
        lightbin::View::from_projection(projection_, {settings.width, settings.height}, {.tile_size = 1}));
    pixel_depth_.resize(pixels.tile_count());
    reduce_on_gpu(pixels, true, {}, pixel_depth_);
    std::uint64_t evaluations = 0;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const float depth =
                pixel_depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(settings.width) +
                             static_cast<std::size_t>(x)];
            if (depth < 0 && std::isinf(depth)) continue;  // nothing is seen there
            evaluations += listed.evaluations(x / settings.tile_size, y / settings.tile_size, depth);
        }
    return static_cast<double>(evaluations) / settings.width / settings.height;
}

void Renderer::draw_heat_map(const FrameReport& report, const FrameSettings& settings) {
    const GLuint program = heat_map_program(slicing_of(settings));
    glUseProgram(program);
    bind_lists(program, opaque_lists_);
    glUniform1f(uniform(program, "longest_list"), static_cast<float>(std::max(report.longest_list, 1u)));
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (slices_) {
        set_matrices(program);
        glDepthFunc(GL_EQUAL);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(scene_.triangles.size()));
    } else {
        glDisable(GL_DEPTH_TEST);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    glDisable(GL_BLEND);
}

// The brighter parts of what is lit are to come out well, whatever unit the scene's lights are in: three
// quarters of the lit pixels stay below the middle of the display's range.
float Renderer::meter(const Camera& camera, const FrameSettings& settings) {
    FrameSettings small = settings;
    small.width = 128;
    small.height = 72;
    small.samples = 1;
    small.tile_size = 8;
    small.exposure = 0;
    small.checks = {};
    draw(camera, small);

    std::vector<glm::vec4> pixels(static_cast<std::size_t>(small.width) *
                                  static_cast<std::size_t>(small.height));
    glReadPixels(0, 0, small.width, small.height, GL_RGBA, GL_FLOAT, pixels.data());
    std::vector<float> lit;
    for (const glm::vec4& pixel : pixels)
        if (const float brightest = std::max({pixel.r, pixel.g, pixel.b}); pixel.a > 0 && brightest > 0)
            lit.push_back(brightest);
    if (lit.empty()) return 1;
    const auto quartile = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() * 3 / 4);
    std::nth_element(lit.begin(), quartile, lit.end());
    return 0.5f / *quartile;
}

Renderer::Renderer(const Scene& scene, int glsl)
    : scene_(scene), glsl_(glsl), list_binding_(list_binding(glsl)), binned_(scene),
      culled_(glsl, binned_.has_spots()), frame_buffer_(glsl) {
    const std::string geometry = geometry_vertex_shader(glsl);
    depth_program_ = link_program(geometry, depth_fragment_shader(glsl));
    brute_force_program_ =
        link_program(geometry, forward_fragment_shader(glsl, LightLoop::every_light,
                                                       {binned_.has_spots(), binned_.has_boxes()}));

    glGenVertexArrays(1, &vertex_array_);
    glBindVertexArray(vertex_array_);
    GLuint vertices = 0;
    glGenBuffers(1, &vertices);
    glBindBuffer(GL_ARRAY_BUFFER, vertices);
    std::vector<Vertex> triangles = scene.triangles;
    triangles.insert(triangles.end(), scene.transparent.begin(), scene.transparent.end());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(Vertex)),
                 triangles.data(), GL_STATIC_DRAW);
    for (const GLuint attribute : {0u, 1u, 2u}) {  // the three vec3 of a Vertex
        glEnableVertexAttribArray(attribute);
        glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(attribute * sizeof(glm::vec3)));
    }

    using lightbin::TexelFormat;
    lights_ = {lightbin::ShaderResource::texture_2d, {GL_RGBA32F, GL_RGBA, GL_FLOAT}, 16};
    opaque_lists_ = {{list_binding_.resource, lightbin::gl_format(TexelFormat::rg32ui), 8},
                     {list_binding_.resource, lightbin::gl_format(TexelFormat::r32ui), 4}};
    boxes_ = lights_;
    transparent_lists_ = opaque_lists_;
    slices_buffer_ = opaque_lists_.indices;
    bins_buffer_ = opaque_lists_.tiles;
    for (GpuBuffer* made :
         {&lights_, &boxes_, &opaque_lists_.tiles, &opaque_lists_.indices, &transparent_lists_.tiles,
          &transparent_lists_.indices, &slices_buffer_, &bins_buffer_}) {
        glGenBuffers(1, &made->buffer);
        glGenTextures(1, &made->texture);
    }

    glGenFramebuffers(1, &reduce_framebuffer_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

void Renderer::start(const Camera& camera, const FrameSettings& settings) {
    frame_buffer_.resize(settings.width, settings.height, settings.samples,
                         settings.exposure == 0 ? GL_RGBA32F : GL_RGBA8);
    frame_buffer_.shade_samples(settings.shades_samples());
    set_camera(camera);
    glBindVertexArray(vertex_array_);  // another's may be bound
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    const bool grey = settings.checks != ShaderChecks{};
    // Alpha tells the light meter where nothing is drawn.
    glClearColor(grey ? 0.025f : 0.02f, 0.025f, grey ? 0.025f : 0.04f, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

// The matrices, and the lights in view space.
void Renderer::set_camera(const Camera& camera) {
    const glm::dmat4 view = glm::inverse(camera.to_world);
    view_ = glm::mat4(view);
    projection_ = projection_of(camera, static_cast<double>(frame_buffer_.width()) / frame_buffer_.height());
    binned_.place(view);
}

void Renderer::draw_depth() const {
    glUseProgram(depth_program_);
    glUniformMatrix4fv(uniform(depth_program_, "view"), 1, GL_FALSE, glm::value_ptr(view_));
    glUniformMatrix4fv(uniform(depth_program_, "projection"), 1, GL_FALSE, glm::value_ptr(projection_));
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(scene_.triangles.size()));
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_LEQUAL);  // what follows is at the depths already there
}

GLuint Renderer::tiled_program(const FrameSettings& settings) {
    const lightbin::Slicing slicing = slicing_of(settings);
    GLuint& program = tiled_programs_[{slicing, settings.checks}];
    if (program == 0)
        program = link_program(geometry_vertex_shader(glsl_),
                               forward_fragment_shader(glsl_, LightLoop::tile_list,
                                                       {binned_.has_spots(), binned_.has_boxes()}, slicing,
                                                       settings.checks));
    return program;
}

GLuint Renderer::heat_map_program(lightbin::Slicing slicing) {
    GLuint& program = heat_map_programs_[static_cast<std::size_t>(slicing)];
    const bool over_picture = slicing == lightbin::Slicing::none;
    if (program == 0)
        program = link_program(over_picture ? overlay_vertex_shader(glsl_) : geometry_vertex_shader(glsl_),
                               heat_map_fragment_shader(glsl_, slicing));
    return program;
}

// What places the triangles.
void Renderer::set_matrices(GLuint program) const {
    glUniformMatrix4fv(uniform(program, "view"), 1, GL_FALSE, glm::value_ptr(view_));
    glUniformMatrix4fv(uniform(program, "projection"), 1, GL_FALSE, glm::value_ptr(projection_));
}

void Renderer::draw_triangles(GLuint program, bool with_lists, const FrameSettings& settings) const {
    glUseProgram(program);
    set_matrices(program);
    glUniform2f(uniform(program, "picture_size"), static_cast<float>(frame_buffer_.width()),
                static_cast<float>(frame_buffer_.height()));
    glUniform3fv(uniform(program, "moon"), 1, glm::value_ptr(glm::mat3(view_) * way_to_moon));
    glUniform1f(uniform(program, "exposure"), settings.exposure);
    // Only shaders for boxes read the number of lights alone.
    glUniform1i(glGetUniformLocation(program, "light_count"), static_cast<int>(scene_.lights.size()));
    glUniform1i(uniform(program, "listed_count"), static_cast<int>(binned_.listed_count()));
    glUniform1i(uniform(program, "sun_count"), static_cast<int>(scene_.suns.size()));
    bind_texture(program, 2, lights_, "lights");
    if (binned_.has_boxes()) bind_texture(program, 6, boxes_, "boxes");
    const auto opaque = static_cast<GLsizei>(scene_.triangles.size());
    if (with_lists) bind_lists(program, opaque_lists_);
    glDrawArrays(GL_TRIANGLES, 0, opaque);
    if (!shows_glass(settings)) return;

    // 1 - (1 - glass) (1 - behind): the light of both, whatever is drawn first, and never more than white.
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_COLOR);
    glDepthMask(GL_FALSE);
    if (with_lists) bind_lists(program, transparent_lists_);
    glDrawArrays(GL_TRIANGLES, opaque, static_cast<GLsizei>(scene_.transparent.size()));
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

// The light meter looks through glass, as not every OpenGL ES blends floats.
bool Renderer::shows_glass(const FrameSettings& settings) const {
    return !scene_.transparent.empty() && settings.exposure != 0;
}

// Hands the lists to the text that lightbin/shader.hpp generates.
void Renderer::bind_lists(GLuint program, const Lists& lists) const {
    glUniform4uiv(uniform(program, "lightbin_grid"), 1, &grid_.tile_size);
    // Where the program has no view check they are at -1, which sets nothing.
    glUniform4fv(glGetUniformLocation(program, "lightbin_image"), 1, &shader_view_.scale_x);
    glUniform4fv(glGetUniformLocation(program, "lightbin_depths"), 1, &shader_view_.forward);
    if (list_binding_.resource == lightbin::ShaderResource::storage_buffer) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, lists.tiles.buffer);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, lists.indices.buffer);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, slices_buffer_.buffer);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, bins_buffer_.buffer);
    } else {
        bind_texture(program, 0, lists.tiles, "lightbin_tiles");
        bind_texture(program, 1, lists.indices, "lightbin_lists");
        bind_texture(program, 4, slices_buffer_, "lightbin_slices");
        bind_texture(program, 5, bins_buffer_, "lightbin_bins");
    }
}

void Renderer::bind_texture(GLuint program, int unit, const GpuBuffer& source, const char* name) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target_of(source.resource), source.texture);
    // A sampler that is not read is optimised away, as the heat map's for ids: -1 sets nothing.
    glUniform1i(glGetUniformLocation(program, name), unit);
}

void Renderer::upload_lights() {
    const std::span<const GpuLight> lights = binned_.in_order();
    upload(lights_, lights.data(), lights.size_bytes(), lights_width, "lights");
    const std::span<const GpuBox> boxes = binned_.boxes();
    if (!boxes.empty()) upload(boxes_, boxes.data(), boxes.size_bytes(), lights_width, "boxes");
}

void Renderer::upload_lists(const Lists& target, const lightbin::LightGrid<std::uint32_t>& grid) const {
    // A 2D texture has a row for each tile row, of each slice.
    upload(target.tiles, grid.ranges().data(), grid.ranges().size_bytes(), grid.tiles_x(), "tiles");
    upload(target.indices, grid.ids().data(), grid.ids().size_bytes(), static_cast<int>(list_binding_.width),
           "light lists");
}

// `width`: texels a row of a 2D texture
void Renderer::upload(const GpuBuffer& target, const void* data, std::size_t bytes, int width,
                      const char* what) const {
    using lightbin::ShaderResource;
    const auto texel = static_cast<std::size_t>(target.texel_bytes),
               row = static_cast<std::size_t>(width) * texel;
    GLint64 most = 0;
    glGetInteger64v(target.resource == ShaderResource::texture_2d     ? GL_MAX_TEXTURE_SIZE
                    : target.resource == ShaderResource::texel_buffer ? GL_MAX_TEXTURE_BUFFER_SIZE
                                                                      : GL_MAX_SHADER_STORAGE_BLOCK_SIZE,
                    &most);
    const std::size_t unit = target.resource == ShaderResource::texture_2d     ? row
                             : target.resource == ShaderResource::texel_buffer ? texel
                                                                               : 1;
    if (bytes > static_cast<std::size_t>(most) * unit || (unit == row && width > most))
        throw std::runtime_error("the " + std::string(what) + " take " + std::to_string(bytes) +
                                 " bytes and shaders here read at most " +
                                 std::to_string(static_cast<std::size_t>(most) * unit) +
                                 ": use larger tiles or fewer lights");
    glActiveTexture(GL_TEXTURE3);
    glBindTexture(target_of(target.resource), target.texture);
    if (target.resource == ShaderResource::texture_2d) {
        const auto rows = static_cast<GLsizei>(bytes / row), rest = static_cast<GLsizei>(bytes % row / texel);
        const auto height = lightbin::texture_rows(bytes / texel, static_cast<std::size_t>(width));
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(target.format.internal), width,
                     static_cast<GLsizei>(height), 0, target.format.layout, target.format.type, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, rows, target.format.layout, target.format.type, data);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, rows, rest, rest > 0 ? 1 : 0, target.format.layout,
                        target.format.type,
                        static_cast<const std::byte*>(data) + static_cast<std::size_t>(rows) * row);
        return;
    }
    glBindBuffer(GL_COPY_WRITE_BUFFER, target.buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 16)), nullptr,
                 GL_STREAM_DRAW);
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
    if (target.resource == ShaderResource::texel_buffer)
        glTexBuffer(GL_TEXTURE_BUFFER, target.format.internal, target.buffer);
}

// Z bounds without reading the depth buffer back: only a tile's two depths are. No `min`: it is not wanted.
void Renderer::reduce_on_gpu(const lightbin::View& view, bool skip_background, std::span<float> min,
                             std::span<float> max) {
    const int samples = frame_buffer_.samples();
    GLuint& program = reduce_programs_[{samples, view.orthographic(), skip_background}];
    if (program == 0)
        program = link_program(overlay_vertex_shader(glsl_),
                               reduce_fragment_shader(glsl_, samples, view.orthographic(), skip_background));
    glUseProgram(program);
    const lightbin::ReduceConstants constants = lightbin::reduce_constants(view);
    glUniform4uiv(uniform(program, "lightbin_grid"), 1, &constants.tile_size);
    glUniform4fv(uniform(program, "lightbin_planes"), 1, &constants.far_end);
    glActiveTexture(GL_TEXTURE0);
    frame_buffer_.bind_depth();
    glUniform1i(uniform(program, "lightbin_depth"), 0);

    glBindFramebuffer(GL_FRAMEBUFFER, reduce_framebuffer_);
    glActiveTexture(GL_TEXTURE3);
    reduced_ = new_texture(reduced_, GL_RG32F, view.tiles_x(), view.tiles_y());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, reduced_, 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("this OpenGL cannot draw to 32-bit floats, which Z bounds on the GPU need");
    glViewport(0, 0, view.tiles_x(), view.tiles_y());
    glDisable(GL_DEPTH_TEST);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
    depth_buffer_.resize(2 * view.tile_count());
    glReadPixels(0, 0, view.tiles_x(), view.tiles_y(), GL_RG, GL_FLOAT, depth_buffer_.data());
    for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
        if (!min.empty()) min[tile] = depth_buffer_[2 * tile];
        max[tile] = depth_buffer_[2 * tile + 1];
    }
    frame_buffer_.bind();
}
