// What the tests ask of every colour function.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/host/color.h"
#include "tests/catch.h"

namespace xorvox::host {

/// Points inside of the box, on its border, and outside.
inline std::vector<glm::vec3> color_points() {
    std::mt19937 random(8);
    // No std::uniform_real_distribution: its numbers are each library's own.
    const auto any = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    std::vector<glm::vec3> points;
    for (int i = 0; i < 600; ++i) {
        glm::vec3 point(any(), any(), any());
        if (i % 5 == 0) point[i % 3] = static_cast<float>(i % 2);
        if (i % 7 == 0) point = 4.0f * point - 1.5f;
        points.push_back(point);
    }
    return points;
}

inline glm::vec3 color_of(const ColorField& field, const glm::vec3& point) {
    glm::vec3 color(-1.0f);
    field.evaluate({&point, 1}, {&color, 1});
    return color;
}

/// Any size of batch gives the same bits, and a point that is far away or no number a colour.
inline void check_batches(const ColorField& field) {
    const std::vector<glm::vec3> points = color_points();
    std::vector<glm::vec3> whole(points.size());
    field.evaluate(points, whole);
    for (const std::size_t size : {1u, 3u, 64u, 255u, 257u}) {
        std::vector<glm::vec3> parts(points.size());
        for (std::size_t at = 0; at < points.size(); at += size) {
            const std::size_t count = std::min<std::size_t>(size, points.size() - at);
            field.evaluate(std::span(points).subspan(at, count), std::span(parts).subspan(at, count));
        }
        REQUIRE(parts == whole);
    }
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float far : {3e38f, -3e38f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 point(0.3f);
            point[axis] = far;
            const glm::vec3 color = color_of(field, point);
            for (int i = 0; i < 3; ++i) REQUIRE(std::isfinite(color[i]));
        }
    }
}

/// Of the bits of the colours of color_points(): FNV-1a.
inline std::uint64_t hash_of(const ColorField& field) {
    const std::vector<glm::vec3> points = color_points();
    std::vector<glm::vec3> colors(points.size());
    field.evaluate(points, colors);
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const glm::vec3& color : colors) {
        for (int i = 0; i < 3; ++i) hash = (hash ^ std::bit_cast<std::uint32_t>(color[i])) * 0x100000001b3;
    }
    return hash;
}

}  // namespace xorvox::host
