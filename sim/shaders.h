// Shaders of the perspective picture. All places are relative to the eye, in units of the camera's distance.
#pragma once

namespace xorvox::sim {

/// A voxel is an ellipsoid. The vertex shader spans a rectangle through its middle that faces the eye and holds all
/// that is seen of it, even where it is nearest to the eye.
inline constexpr const char* kVoxelVertex = R"(#version 450 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 half_size;
layout(location = 2) in vec2 across;
layout(location = 3) in vec3 normal;
layout(location = 4) in vec3 light;
layout(location = 5) in float open;
uniform mat4 to_clip;
uniform vec3 camera_up;
flat out vec3 voxel_place;
flat out vec3 voxel_half;
flat out vec2 voxel_across;
flat out vec3 voxel_normal;
flat out vec3 voxel_light;
flat out float voxel_open;
out vec3 from_middle;
float reach_along(vec3 v) {
    return length(half_size * vec3(dot(v.xy, across), dot(v.xy, vec2(-across.y, across.x)), v.z));
}
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    float away = length(place);
    vec3 side = normalize(cross(place, camera_up));
    vec3 top = cross(side, place / away);
    float nearer = 1.0 - reach_along(place / away) / away;
    from_middle = (corner.x * reach_along(side) * side + corner.y * reach_along(top) * top) / max(nearer, 0.1);
    voxel_place = place;
    voxel_half = half_size;
    voxel_across = across;
    voxel_normal = normal;
    voxel_light = light;
    voxel_open = open;
    gl_Position = to_clip * vec4(place + from_middle, 1.0);
}
)";

/// Where the ray through the pixel meets the ellipsoid; shaded there, half as a bead, half as a part of the body.
inline constexpr const char* kVoxelFragment = R"(#version 450 core
flat in vec3 voxel_place;
flat in vec3 voxel_half;
flat in vec2 voxel_across;
flat in vec3 voxel_normal;
flat in vec3 voxel_light;
flat in float voxel_open;
in vec3 from_middle;
uniform mat4 to_clip;
uniform vec3 lamp;
out vec4 film;
vec3 to_voxel(vec3 v) {
    return vec3(dot(v.xy, voxel_across), dot(v.xy, vec2(-voxel_across.y, voxel_across.x)), v.z);
}
vec3 to_world(vec3 v) {
    return vec3(v.x * voxel_across + v.y * vec2(-voxel_across.y, voxel_across.x), v.z);
}
vec3 unit_or(vec3 v, vec3 otherwise) {
    float size = length(v);
    return size > 1e-6 ? v / size : otherwise;
}
void main() {
    vec3 ray = normalize(voxel_place + from_middle);
    // Units in which the ellipsoid is the unit ball, from the square and not from the eye: small numbers keep their digits.
    vec3 start = to_voxel(from_middle) / voxel_half;
    vec3 step = to_voxel(ray) / voxel_half;
    float a = dot(step, step);
    float b = dot(start, step);
    float d = b * b - a * (dot(start, start) - 1.0);
    if (d < 0.0) discard;
    float t = (-b - sqrt(d)) / a;
    vec4 clip = to_clip * vec4(voxel_place + from_middle + t * ray, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;

    vec3 bead = normalize(to_world((start + t * step) / voxel_half));
    // The bead's own normal decides where the body is too thin to have one.
    float body = 0.7 * smoothstep(-0.4, 0.1, dot(voxel_normal, -ray)) * (1.0 - smoothstep(0.65, 0.9, voxel_open));
    vec3 n = unit_or(mix(bead, voxel_normal, body), bead);
    float lit = max(dot(n, lamp) + 0.1, 0.0) / 1.1;
    // Rounding makes the product of two unit vectors a little more than 1, and a power of a negative number is none.
    float rim = pow(1.0 - clamp(dot(n, -ray), 0.0, 1.0), 3.0);
    float sky = smoothstep(0.0, 0.6, voxel_open);
    film = vec4(voxel_light * (0.05 + 0.17 * sky + 1.05 * lit * mix(0.4, 1.0, sky) + 0.12 * rim), 1.0);
}
)";

/// A segment is a strip of even width on the screen.
inline constexpr const char* kLineVertex = R"(#version 450 core
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
uniform mat4 to_clip;
uniform vec2 half_width;
out float away;
void main() {
    vec4 a = to_clip * vec4(from, 1.0);
    vec4 b = to_clip * vec4(to, 1.0);
    vec2 way = (b.xy / b.w - a.xy / a.w) / half_width;
    vec2 run = dot(way, way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);  // seen end-on it has no direction
    vec4 end = gl_VertexID >= 2 ? b : a;
    float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
    away = end.w;
    gl_Position = end + vec4(side * vec2(-run.y, run.x) * half_width * end.w, 0.0, 0.0);
}
)";

inline constexpr const char* kLineFragment = R"(#version 450 core
in float away;
uniform vec3 tint;
out vec4 film;
void main() { film = vec4(tint / (away * away), 0.0); }
)";

}  // namespace xorvox::sim
