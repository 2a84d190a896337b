// SPDX-License-Identifier: MIT
#include "projection.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace {

glm::dmat4 for_opengl(const Camera& camera, double aspect) {
    if (camera.orthographic) {
        const double y = camera.height / 2, x = y * aspect;
        return glm::ortho(-x, x, -y, y, camera.near, camera.far);
    }
    if (std::isinf(camera.far)) return glm::infinitePerspective(camera.height, aspect, camera.near);
    return glm::perspective(camera.height, aspect, camera.near, camera.far);
}

}  // namespace

glm::mat4 projection_of(const Camera& camera, double aspect, lightbin::ClipDepth clip_depth) {
    glm::dmat4 projection = for_opengl(camera, aspect);
    if (clip_depth == lightbin::ClipDepth::zero_to_one)
        for (int column = 0; column < 4; ++column)
            projection[column][2] = (projection[column][2] + projection[column][3]) / 2;
    return glm::mat4(projection);
}
