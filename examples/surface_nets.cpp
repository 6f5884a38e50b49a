#include "examples/surface_nets.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

namespace xorvox::examples {
namespace {

using Vec = glm::dvec3;
using Field = double (*)(const Vec&);

constexpr std::uint32_t kNone = 0xffff'ffff;
constexpr int kRelaxations = 12;

struct Grid {
    Vec min;
    double step;
    std::array<std::size_t, 3> size;  // Samples a side.

    std::size_t stride(std::size_t axis) const { return axis == 0 ? 1 : axis == 1 ? size[0] : size[0] * size[1]; }
    std::size_t count() const { return size[0] * size[1] * size[2]; }
    Vec position(std::size_t sample) const {
        const Vec index(sample % size[0], sample / size[0] % size[1], sample / stride(2));
        return min + step * index;
    }
};

Grid make_grid(const Vec& min, const Vec& max, double step) {
    Grid grid{min, step, {}};
    for (int axis = 0; axis < 3; ++axis) {
        grid.size[static_cast<std::size_t>(axis)] = static_cast<std::size_t>((max[axis] - min[axis]) / step) + 2;
    }
    return grid;
}

// The mean of the crossings on the twelve edges of the cell whose lowest corner is `sample`; false when there are none.
bool crossing_mean(const Grid& grid, const std::vector<double>& values, std::size_t sample, Vec& mean) {
    Vec sum(0.0);
    int crossings = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = grid.stride((axis + 1) % 3);
        const std::size_t v = grid.stride((axis + 2) % 3);
        for (const std::size_t from : {sample, sample + u, sample + v, sample + u + v}) {
            const double a = values[from];
            const double b = values[from + grid.stride(axis)];
            if ((a < 0) == (b < 0)) continue;
            const Vec at = grid.position(from);
            sum += at + (a / (a - b)) * (grid.position(from + grid.stride(axis)) - at);
            ++crossings;
        }
    }
    if (crossings > 0) mean = sum / static_cast<double>(crossings);
    return crossings > 0;
}

using Quad = std::array<std::uint32_t, 4>;

struct Net {
    std::vector<Vec> vertices;
    std::vector<Quad> quads;  // Counterclockwise seen from outside.
};

Net make_net(const Grid& grid, const std::vector<double>& values) {
    Net net;
    std::vector<std::uint32_t> vertex_of(grid.count(), kNone);  // Of the cell whose lowest corner is this sample.
    for (std::size_t z = 0; z + 1 < grid.size[2]; ++z) {
        for (std::size_t y = 0; y + 1 < grid.size[1]; ++y) {
            for (std::size_t x = 0; x + 1 < grid.size[0]; ++x) {
                const std::size_t cell = x + y * grid.stride(1) + z * grid.stride(2);
                if (Vec mean; crossing_mean(grid, values, cell, mean)) {
                    vertex_of[cell] = static_cast<std::uint32_t>(net.vertices.size());
                    net.vertices.push_back(mean);
                }
            }
        }
    }
    // A quad around every grid edge that crosses the surface, joining the four cells that share the edge.
    for (std::size_t sample = 0; sample < grid.count(); ++sample) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t end = sample + grid.stride(axis);
            if (end >= grid.count() || (values[sample] < 0) == (values[end] < 0)) continue;
            const std::size_t u = grid.stride((axis + 1) % 3);
            const std::size_t v = grid.stride((axis + 2) % 3);
            Quad quad{vertex_of[sample - u - v], vertex_of[sample - v], vertex_of[sample], vertex_of[sample - u]};
            if (values[sample] >= 0) std::swap(quad[1], quad[3]);
            net.quads.push_back(quad);
        }
    }
    return net;
}

Vec gradient(Field field, const Vec& p, double step) {
    const Vec x(step, 0, 0), y(0, step, 0), z(0, 0, step);
    return Vec(field(p + x) - field(p - x), field(p + y) - field(p - y), field(p + z) - field(p - z)) / (2 * step);
}

// Moves p onto the surface by Newton's method along the gradient.
Vec project(Field field, Vec p, double step) {
    for (int i = 0; i < 3; ++i) {
        const Vec g = gradient(field, p, step / 64);
        const double square = glm::dot(g, g);
        if (square == 0) break;
        Vec move = (field(p) / square) * g;
        // Where the field is rough, a long step would leave the neighbourhood.
        if (const double length = glm::length(move); length > step / 2) move *= step / 2 / length;
        p -= move;
    }
    return p;
}

// Each vertex goes halfway to the mean of its neighbours and back to the surface.
void relax(Net& net, Field field, double step) {
    std::vector<Vec> sum(net.vertices.size(), Vec(0.0));
    std::vector<double> count(net.vertices.size(), 0.0);
    for (const Quad& quad : net.quads) {
        for (std::size_t i = 0; i < 4; ++i) {
            sum[quad[i]] += net.vertices[quad[(i + 1) % 4]] + net.vertices[quad[(i + 3) % 4]];
            count[quad[i]] += 2;
        }
    }
    for (std::size_t v = 0; v < net.vertices.size(); ++v) {
        net.vertices[v] = project(field, 0.5 * net.vertices[v] + 0.5 * sum[v] / count[v], step);
    }
}

}  // namespace

Mesh surface_nets(Field field, const Vec& min, const Vec& max, double step) {
    const Grid grid = make_grid(min, max, step);
    std::vector<double> values(grid.count());
    for (std::size_t sample = 0; sample < values.size(); ++sample) values[sample] = field(grid.position(sample));

    Net net = make_net(grid, values);
    for (int i = 0; i < kRelaxations; ++i) relax(net, field, step);

    Mesh mesh;
    mesh.positions.reserve(net.vertices.size());
    for (const Vec& v : net.vertices) mesh.positions.emplace_back(glm::vec3(v));
    mesh.indices.reserve(6 * net.quads.size());
    const auto distance = [&mesh](std::uint32_t a, std::uint32_t b) {
        return glm::length(mesh.positions[a] - mesh.positions[b]);
    };
    for (const auto& [a, b, c, d] : net.quads) {
        if (distance(a, c) <= distance(b, d)) {
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        } else {
            mesh.indices.insert(mesh.indices.end(), {b, c, d, b, d, a});
        }
    }
    return mesh;
}

}  // namespace xorvox::examples
