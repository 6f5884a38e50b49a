#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "tests/catch.h"
#include "voxelizer/noise.h"

using xorvox::perlin_noise;
using xorvox::simplex_noise;

TEST_CASE("noise is zero at every point of whole coordinates") {
    for (int x = -9; x <= 300; x += 7) {
        for (int y = -300; y <= 9; y += 11) {
            for (int z = -20; z <= 20; ++z) REQUIRE(perlin_noise(glm::vec3(x, y, z)) == 0.0f);
        }
    }
}

TEST_CASE("noise is continuous within and across cells") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-20.0f, 20.0f);
    for (int i = 0; i < 20000; ++i) {
        glm::vec3 a(place(random), place(random), place(random));
        const int axis = i % 3;
        if (i % 2 == 0) a[axis] = std::round(a[axis]) - 0.0005f;  // The step of 0.001 crosses into the next cell.
        glm::vec3 b = a;
        b[axis] += 0.001f;
        REQUIRE(std::abs(perlin_noise(a) - perlin_noise(b)) < 0.005f);
    }
}

TEST_CASE("noise has the stated range, mean and size of features") {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> place(-100.0f, 100.0f);
    double sum = 0;
    double squares = 0;
    float least = 0;
    float most = 0;
    constexpr int n = 400000;
    for (int i = 0; i < n; ++i) {
        const float value = perlin_noise({place(random), place(random), place(random)});
        least = std::min(least, value);
        most = std::max(most, value);
        sum += value;
        squares += double{value} * value;
    }
    CHECK(least >= -1.04f);
    CHECK(most <= 1.04f);
    CHECK(least < -0.8f);
    CHECK(most > 0.8f);
    CHECK(std::abs(sum / n) < 0.005);
    CHECK(std::sqrt(squares / n) == Approx(0.27).margin(0.02));
}

TEST_CASE("noise repeats after 256 units and not before") {
    int same = 0;
    for (int i = 0; i < 256; ++i) {
        const glm::vec3 p(0.25f, 0.5f, static_cast<float>(i) + 0.75f);
        REQUIRE(perlin_noise(p) == perlin_noise(p + glm::vec3(256, 0, -256)));
        same += perlin_noise(p) == perlin_noise(p + glm::vec3(0, 0, 128));
    }
    CHECK(same < 40);
}

TEST_CASE("noise has the same bits on every machine") {
    CHECK(perlin_noise({0.5f, 0.5f, 0.5f}) == 0x1.8p-2f);
    CHECK(perlin_noise({1.25f, -3.5f, 7.75f}) == -0x1.1a1d6p-1f);
    CHECK(perlin_noise({100.1f, 200.2f, -300.3f}) == 0x1.e382d8p-3f);
}

TEST_CASE("noise at many points is the noise at each of them") {
    std::mt19937 random(12);
    std::uniform_real_distribution<float> place(-300.0f, 300.0f);
    std::vector<glm::vec3> points;
    for (const float step : {0.001f, 0.03f, 0.3f, 5.0f}) {
        for (int row = 0; row < 50; ++row) {
            const glm::vec3 first(place(random), place(random), place(random));
            for (int i = 0; i < 37; ++i)
                points.push_back(first + static_cast<float>(i) * step * glm::vec3(1, -0.2f, 0.1f));
        }
    }
    for (const glm::vec3 odd :
         {glm::vec3(NAN), glm::vec3(1, INFINITY, 0), glm::vec3(5e6f), glm::vec3(-0x1p22f), glm::vec3(0x1p22f)}) {
        points.insert(points.end(), 19, odd);
    }
    std::vector<float> values(points.size());
    for (std::size_t first = 0; first < 9; ++first) {
        perlin_noise(std::span(points).subspan(first), std::span(values).subspan(first));
        for (std::size_t i = first; i < points.size(); ++i) REQUIRE(values[i] == perlin_noise(points[i]));
    }
}

TEST_CASE("simplex noise is continuous within and across its tetrahedra") {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> place(-20.0f, 20.0f);
    for (int i = 0; i < 200000; ++i) {
        const glm::vec3 a(place(random), place(random), place(random));
        glm::vec3 b = a;
        b[i % 3] += 0.001f;
        REQUIRE(std::abs(simplex_noise(a) - simplex_noise(b)) < 0.008f);
    }
}

TEST_CASE("simplex noise has the stated range and mean") {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-100.0f, 100.0f);
    double sum = 0;
    double squares = 0;
    float least = 0;
    float most = 0;
    constexpr int n = 400000;
    for (int i = 0; i < n; ++i) {
        const float value = simplex_noise({place(random), place(random), place(random)});
        least = std::min(least, value);
        most = std::max(most, value);
        sum += value;
        squares += double{value} * value;
    }
    CHECK(least >= -1.0f);
    CHECK(most <= 1.0f);
    CHECK(least < -0.9f);
    CHECK(most > 0.9f);
    CHECK(std::abs(sum / n) < 0.005);
    CHECK(std::sqrt(squares / n) == Approx(0.39).margin(0.02));
}

TEST_CASE("simplex noise has the same bits on every machine") {
    CHECK(simplex_noise({0.0f, 0.0f, 0.0f}) == 0.0f);
    CHECK(simplex_noise({0.5f, 0.25f, 0.125f}) == 0x1.beee74p-2f);
    CHECK(simplex_noise({100.1f, 200.2f, -300.3f}) == 0x1.92a99p-3f);
}

TEST_CASE("there is no noise where coordinates are too large or no numbers") {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float far : {5e6f, -5e6f, 3e38f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 point(0.3f);
            point[axis] = far;
            CHECK(perlin_noise(point) == 0.0f);
            CHECK(simplex_noise(point) == 0.0f);
        }
    }
}
