// SPDX-License-Identifier: MIT
// lightbin in OpenSceneGraph: its scene graph, its camera, 2,500 lights that move. docs/openscenegraph.md says what had
// to be adapted. Opens a window; or without a display
//   --output PNG  draws a picture
//   --check       draws frames by the lists and by every light, and compares them byte by byte;
//                 with --stale it fails, as the lists stay those of the first frame
//   --time        draws frames of 640 x 360 pixels in both ways, in turns, and prints the least times
#include "shaders.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>

#include <osg/ArgumentParser>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osg/TextureBuffer>
#include <osgDB/WriteFile>
#include <osgViewer/Viewer>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "openscenegraph: %s\n", why.c_str());
    std::exit(EXIT_FAILURE);
}

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// In the world, and as the shader reads it.
struct Light {
    lightbin::Sphere sphere;
    osg::Vec4f colour;
};

// A buffer texture that is filled anew each frame. OpenSceneGraph uploads the array before it draws.
struct Buffer {
    osg::ref_ptr<osg::UIntArray> words = new osg::UIntArray;

    Buffer(osg::StateSet& state, int unit, const char* sampler, int format) {
        osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer(words);
        texture->setInternalFormat(format);
        state.setTextureAttribute(static_cast<unsigned>(unit), texture);
        state.addUniform(new osg::Uniform(sampler, unit));
    }

    template <class Elements> void fill(const Elements& elements) const {
        const std::size_t bytes = elements.size() * sizeof *elements.data();
        words->resize(bytes / sizeof(GLuint));
        std::memcpy(words->asVector().data(), elements.data(), bytes);
        words->dirty();
    }
};

// Lights all that has a state set. A camera's initial draw callback: it is called in each frame when the matrices are
// those that will be drawn with, near and far planes as OpenSceneGraph has fitted them, whoever has the viewer's loop.
struct LightLists : osg::Camera::DrawCallback {
    std::vector<Light> lights;
    mutable double lists_ms = 0;        // what the last lists took, with their copies for the upload
    mutable lightbin::Binner<> binner;  // the callback is const
    Buffer tiles, ids, light_data;
    osg::ref_ptr<osg::Uniform> grid = new osg::Uniform(osg::Uniform::UNSIGNED_INT_VEC4, "lightbin_grid");
    osg::ref_ptr<osg::Uniform> every_light = new osg::Uniform("every_light", false);

    explicit LightLists(osg::StateSet& state)
        : tiles(state, 0, "lightbin_tiles", GL_RG32UI), ids(state, 1, "lightbin_lists", GL_R32UI),
          light_data(state, 2, "lights", GL_RGBA32F_ARB) {
        const auto snippet = lightbin::shader_snippet(
            {.language = lightbin::ShaderLanguage::glsl_330, .storage = lightbin::ListStorage::texel_buffer});
        const std::string text = "#version 330 compatibility\n" + snippet->text + fragment_text;
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex_text));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, text));
        state.setAttributeAndModes(program);
        state.addUniform(grid);
        state.addUniform(every_light);
    }

    void operator()(osg::RenderInfo& info) const override {
        const auto begin = std::chrono::steady_clock::now();
        const osg::Camera& camera = *info.getCurrentCamera();
        const osg::Viewport& window = *camera.getViewport();
        const lightbin::ImageSize size{static_cast<int>(window.width()), static_cast<int>(window.height())};
        // Made anew each frame, which costs nothing beside the lists: no change of lens or window is missed.
        const auto view = lightbin::View::from_projection(camera.getProjectionMatrix(), size);
        if (!view) fail(view.error().message());
        const auto to_sphere = [](const Light& light) { return light.sphere; };
        const auto lists = binner.bin(*view, lightbin::world_space(lights, camera.getViewMatrix(), to_sphere));
        if (!lists) fail(lists.error().message());

        tiles.fill(lists->ranges());
        ids.fill(lists->ids());
        light_data.fill(lights);
        const lightbin::GridConstants constants = lightbin::grid_constants(*view);
        grid->set(constants.tile_size, constants.tiles_x, constants.width, constants.height);
        lists_ms = milliseconds_since(begin);
    }
};

// A floor, and 625 boxes, columns and balls on it.
osg::ref_ptr<osg::Group> make_scene() {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(new osg::ShapeDrawable(new osg::Box({0, 0, -0.5f}, 100, 100, 1)));
    for (int i = 0; i < 625; ++i) {
        const float half = 0.4f + 0.04f * static_cast<float>(i * i % 29);
        osg::ref_ptr<osg::Shape> shape = new osg::Sphere({0, 0, half}, half);
        if (i % 3 == 0) shape = new osg::Box({0, 0, half}, 1.5f, 1.5f, 2 * half);
        if (i % 3 == 1) shape = new osg::Cylinder({0, 0, half}, 0.6f, 2 * half);
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
        place->setMatrix(osg::Matrixd::rotate(i, osg::Z_AXIS) *
                         osg::Matrixd::translate(3.4 * (i % 25 - 12), 3.4 * (i / 25 - 12), 0));
        place->addChild(new osg::ShapeDrawable(shape.get()));  // of a ref_ptr 3.6 makes a black one
        scene->addChild(place);
    }
    return scene;
}

// Lights of every colour circle, each at its own pace, and the camera goes round.
void draw(osgViewer::Viewer& viewer, LightLists& lists, double seconds) {
    std::minstd_rand random(2);
    const auto any = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
    lists.lights.resize(2500);
    for (Light& light : lists.lights) {
        const float hue = any(0, 6.28f), angle = hue + any(-2, 2) * static_cast<float>(seconds);
        const float x = any(-45, 45), y = any(-45, 45), z = any(0.2f, 3);
        light.sphere = {x + 2 * std::cos(angle), y + 2 * std::sin(angle), z, 3};
        light.colour = {std::cos(hue) + 1, std::cos(hue + 2.1f) + 1, std::cos(hue + 4.2f) + 1, 0};
    }
    const osg::Vec3d eye(38 * std::cos(0.2 * seconds), 38 * std::sin(0.2 * seconds), 14);
    viewer.getCamera()->setViewMatrixAsLookAt(eye, {0, 0, -6}, osg::Z_AXIS);
    viewer.frame();
}

// Without a display: EGL gives OpenGL, and what is drawn goes to an image.
void draw_to(osg::Image& image, osgViewer::Viewer& viewer) {
    const EGLDisplay egl = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (!eglInitialize(egl, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) fail("no usable OpenGL");
    const EGLContext context = eglCreateContext(egl, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    if (!context || !eglMakeCurrent(egl, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) fail("no OpenGL context");
    viewer.setUpViewerAsEmbeddedInWindow(0, 0, image.s(), image.t());
    viewer.getCamera()->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    viewer.getCamera()->attach(osg::Camera::COLOR_BUFFER, &image);
    viewer.getCamera()->attach(osg::Camera::DEPTH_BUFFER, GL_DEPTH_COMPONENT24);
}

// Draws frames by the lists and by every light, and says whether they are the same, byte for byte.
bool check(osgViewer::Viewer& viewer, LightLists& lists, const osg::Image& image, bool stale) {
    bool identical = true;
    for (const int second : {0, 1, 2, 3}) {
        viewer.getCamera()->resize(112 + second / 2 * 37, 70,
                                   osg::Camera::RESIZE_DEFAULT | osg::Camera::RESIZE_PROJECTIONMATRIX);
        draw(viewer, lists, second);
        const std::vector<unsigned char> by_lists(image.data(), image.data() + image.getTotalSizeInBytes());
        lists.every_light->set(true);
        draw(viewer, lists, second);
        lists.every_light->set(false);
        const bool same = std::equal(by_lists.begin(), by_lists.end(), image.data());
        const auto bright = std::count_if(by_lists.begin(), by_lists.end(), [](int b) { return b > 127; });
        std::printf("%d x %d pixels, %td bytes bright: %s\n", image.s(), image.t(), bright,
                    same ? "identical" : "DIFFERENT");
        identical = identical && same;
        if (stale) viewer.getCamera()->setInitialDrawCallback(nullptr);
    }
    return identical;
}

// Draws frames in both ways, in turns, and prints the least times.
void time_frames(osgViewer::Viewer& viewer, LightLists& lists) {
    double least[2] = {HUGE_VAL, HUGE_VAL}, lists_ms = HUGE_VAL;
    for (int frame = 0; frame < 4; ++frame) {
        const bool every = frame % 2 == 1;
        lists.every_light->set(every);
        const auto begin = std::chrono::steady_clock::now();
        draw(viewer, lists, 0.1 * frame);  // ends when the picture has been read back
        least[every] = std::min(least[every], milliseconds_since(begin));
        lists_ms = std::min(lists_ms, lists.lists_ms);
    }
    std::printf("a frame by the lists: %.1f ms, of it the lists %.2f ms; by every light: %.0f ms\n", least[0],
                lists_ms, least[1]);
}

int main(int count, char** words) {
    osg::ArgumentParser arguments(&count, words);
    std::string output;
    const bool checked = arguments.read("--check"), stale = arguments.read("--stale"),
               timed = arguments.read("--time");
    const bool offscreen = arguments.read("--output", output) || checked || timed;
    if (count > 1) fail("unknown: " + std::string(words[1]));

    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    viewer.setSceneData(make_scene());
    osg::ref_ptr<LightLists> lists = new LightLists(*viewer.getCamera()->getOrCreateStateSet());
    viewer.getCamera()->setInitialDrawCallback(lists);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(timed ? 640 : 1280, timed ? 360 : 720, 1, GL_RGB, GL_UNSIGNED_BYTE);
    if (offscreen)
        draw_to(*image, viewer);
    else
        viewer.setUpViewInWindow(50, 50, image->s(), image->t());
    viewer.realize();
    if (!viewer.isRealized()) fail("no window; --output FILE.png needs none");
    // What is in view reaches farther than 40: OpenSceneGraph moves the planes to where it ends.
    viewer.getCamera()->setProjectionMatrixAsPerspective(50, 16.0 / 9, 1, 40);

    if (checked) return check(viewer, *lists, *image, stale) ? EXIT_SUCCESS : EXIT_FAILURE;
    if (timed) return time_frames(viewer, *lists), EXIT_SUCCESS;
    while (!offscreen && !viewer.done())
        draw(viewer, *lists, viewer.elapsedTime());
    if (!offscreen) return EXIT_SUCCESS;
    draw(viewer, *lists, 0);
    if (!osgDB::writeImageFile(*image, output)) fail("cannot write " + output);
}
