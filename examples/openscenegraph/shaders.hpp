// SPDX-License-Identifier: MIT
// The shaders, in the GLSL that OpenSceneGraph's nodes feed: gl_Vertex, gl_Normal, gl_Color and its matrices.
#pragma once

inline const char* const vertex_text = R"(#version 330 compatibility
uniform mat4 osg_ViewMatrixInverse;  // OpenSceneGraph sets it
out vec3 position, normal, surface;  // in the world

void main() {
    position = (osg_ViewMatrixInverse * (gl_ModelViewMatrix * gl_Vertex)).xyz;
    normal = mat3(osg_ViewMatrixInverse) * (gl_NormalMatrix * gl_Normal);
    surface = gl_Color.rgb;
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
}
)";

// Goes below #version and lightbin's text.
inline const char* const fragment_text = R"(
uniform samplerBuffer lights;  // two texels each, see Light
uniform bool every_light;      // all of them are taken, and no list is read
in vec3 position, normal, surface;
out vec4 pixel;

// Zero at the range and beyond, so that a light that is not listed would add nothing.
vec3 shade(int light) {
    vec4 sphere = texelFetch(lights, 2 * light);
    vec3 way = sphere.xyz - position;
    float reached = dot(way, way) / (sphere.w * sphere.w);
    float window = max(1.0 - reached, 0.0);
    float facing = max(dot(normalize(normal), normalize(way)), 0.0);
    return texelFetch(lights, 2 * light + 1).rgb * (facing * window * window / (0.02 + reached));
}

void main() {
    vec3 sum = vec3(0.2);
    if (every_light)
        for (int i = 0; i < textureSize(lights) / 2; ++i) sum += shade(i);
    else
        lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), 0.0) sum += shade(int(light.id));
    pixel = vec4(pow(1.0 - exp(-0.1 * surface * sum), vec3(1.0 / 2.2)), 1.0);
}
)";
