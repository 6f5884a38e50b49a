#include "voxelizer/nearest_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace xorvox {
namespace {

constexpr std::size_t kMostInLeaf = 2;
/// Plates are larger by this share of the whole, far more than floats and the doubles of look_at() err.
constexpr double kMargin = 4e-6;
/// Plates are looked into that are farther than the best place by this share, for the same reason.
constexpr double kReach = 1.0 + 2e-5;
/// What floats may lose where one square is taken from another, as a share.
constexpr float kLost = 2e-6f;
/// Triangles whose squared area is a smaller share of their sides' are thin.
constexpr double kThin = 1e-8;

double inverse(double x) {
    return x > 1e-280 ? 1.0 / x : 0.0;
}

/// x, or 0 where it is less, without a branch, which would keep loops from being turned into vectors.
float positive(float x) {
    return 0.5f * (x + std::abs(x));
}

double clamp_01(double t) {
    return t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
}

}  // namespace

NearestSurface::NearestSurface(const MeshView& mesh) : vertex_count_(mesh.positions.size()) {
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
        for (std::size_t r = mesh.face_begin(face); r < mesh.face_end(face); ++r) {
            const auto ring = mesh.ring(r);
            const auto first = static_cast<std::uint32_t>(ring.data() - mesh.indices.data());
            for (std::uint32_t i = 1; i + 1 < ring.size(); ++i) {
                sources_.push_back({static_cast<std::uint32_t>(face),
                                    {first, first + i, first + i + 1},
                                    {ring[0], ring[i], ring[i + 1]}});
            }
        }
    }
    while (leaf_count_ * kMostInLeaf < sources_.size()) leaf_count_ *= 4;
    inner_count_ = (leaf_count_ - 1) / 3;
    plates_.resize(inner_count_);
    triangles_.resize(sources_.size());
    std::vector<glm::dvec3> middles(sources_.size());
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        for (const std::uint32_t vertex : sources_[i].vertices) middles[i] += mesh.positions[vertex];
    }
    sort(middles);
    set_positions(mesh.positions);
}

void NearestSurface::sort(std::span<const glm::dvec3> middles) {
    std::vector<std::uint32_t> order(middles.size());
    std::iota(order.begin(), order.end(), 0u);
    // Leaves begin … end get their triangles: halves of the longest side, until there is one leaf.
    const auto divide = [&](const auto& again, std::size_t begin, std::size_t end) -> void {
        if (end - begin == 1) return;
        const auto first = order.begin() + static_cast<std::ptrdiff_t>(first_triangle(begin));
        const auto last = order.begin() + static_cast<std::ptrdiff_t>(first_triangle(end));
        const std::size_t half = begin + (end - begin) / 2;
        const auto middle = order.begin() + static_cast<std::ptrdiff_t>(first_triangle(half));
        glm::dvec3 lower(std::numeric_limits<double>::infinity());
        glm::dvec3 upper(-std::numeric_limits<double>::infinity());
        for (auto i = first; i != last; ++i) {
            lower = glm::min(lower, middles[*i]);
            upper = glm::max(upper, middles[*i]);
        }
        const glm::dvec3 size = upper - lower;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(middles[a][axis], a) < std::pair(middles[b][axis], b);
        });
        again(again, begin, half);
        again(again, half, end);
    };
    divide(divide, 0, leaf_count_);
    for (std::size_t i = 0; i < order.size(); ++i) triangles_[i].number = order[i];
}

void NearestSurface::set_positions(std::span<const glm::dvec3> positions) {
    if (positions.size() != vertex_count_) return;
    for (Triangle& t : triangles_) {
        const auto& vertices = sources_[t.number].vertices;
        t.a = positions[vertices[0]];
        t.ab = positions[vertices[1]] - t.a;
        t.ac = positions[vertices[2]] - t.a;
        const glm::dvec3 bc = t.ac - t.ab;
        t.ab_ab = glm::dot(t.ab, t.ab);
        t.ab_ac = glm::dot(t.ab, t.ac);
        t.ac_ac = glm::dot(t.ac, t.ac);
        const double area = t.ab_ab * t.ac_ac - t.ab_ac * t.ab_ac;
        t.per_ab = inverse(t.ab_ab);
        t.per_ac = inverse(t.ac_ac);
        t.per_bc = inverse(glm::dot(bc, bc));
        t.per_area = inverse(area);
        t.is_thin = !(area > kThin * t.ab_ab * t.ac_ac);
    }
    refit();
}

void NearestSurface::refit() {
    if (triangles_.empty()) return;
    glm::dvec3 lower(std::numeric_limits<double>::infinity());
    glm::dvec3 upper(-std::numeric_limits<double>::infinity());
    for (const Triangle& t : triangles_) {
        for (const glm::dvec3& corner : {t.a, t.a + t.ab, t.a + t.ac}) {
            lower = glm::min(lower, corner);
            upper = glm::max(upper, corner);
        }
    }
    center_ = 0.5 * (lower + upper);
    const glm::dvec3 size = upper - lower;
    const glm::dvec3 far = glm::max(glm::abs(lower), glm::abs(upper));
    // Doubles are as fine as the coordinates are large; floats, which are relative to the centre, as the mesh is.
    const double margin = kMargin * std::max({size.x, size.y, size.z}) + 1e-14 * std::max({far.x, far.y, far.z});
    // The nodes of a level have the leaves in turn, each as many.
    std::size_t node = 0;
    for (std::size_t nodes = 1; nodes < leaf_count_; nodes *= 4) {
        const std::size_t leaves = leaf_count_ / nodes / 4;  // of a child
        for (std::size_t leaf = 0; leaf < leaf_count_; ++node) {
            for (std::size_t child = 0; child < 4; ++child, leaf += leaves) {
                fit_plate(first_triangle(leaf), first_triangle(leaf + leaves), margin, plates_[node], child);
            }
        }
    }
}

void NearestSurface::fit_plate(std::size_t begin, std::size_t end, double margin, Plates& plates,
                               std::size_t child) const {
    const auto triangles = std::span(triangles_).subspan(begin, end - begin);
    glm::dvec3 lower(std::numeric_limits<double>::infinity());
    glm::dvec3 upper(-std::numeric_limits<double>::infinity());
    glm::dvec3 sum(0.0);
    for (const Triangle& t : triangles) {
        for (const glm::dvec3& corner : {t.a, t.a + t.ab, t.a + t.ac}) {
            lower = glm::min(lower, corner);
            upper = glm::max(upper, corner);
        }
        sum += glm::cross(t.ab, t.ac);
    }
    // Any direction is right, this one mostly good.
    const double length = std::sqrt(glm::dot(sum, sum));
    const glm::vec3 normal = length > 1e-140 ? glm::vec3(sum / length) : glm::vec3(0.0f, 0.0f, 1.0f);
    const glm::vec3 center = triangles.empty() ? glm::vec3(0.0f) : glm::vec3(0.5 * (lower + upper) - center_);
    const glm::dvec3 exact_center = glm::dvec3(center) + center_;
    const glm::dvec3 exact_normal(normal);
    double height = 0.0;
    double radius_squared = 0.0;
    for (const Triangle& t : triangles) {
        for (const glm::dvec3& corner : {t.a, t.a + t.ab, t.a + t.ac}) {
            const glm::dvec3 from = corner - exact_center;
            const double along = glm::dot(from, exact_normal);
            const glm::dvec3 across = from - along * exact_normal;
            height = std::max(height, std::abs(along));
            radius_squared = std::max(radius_squared, glm::dot(across, across));
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        plates.center[static_cast<std::size_t>(axis)][child] = center[axis];
        plates.normal[static_cast<std::size_t>(axis)][child] = normal[axis];
    }
    plates.height[child] = static_cast<float>(height + margin);
    // Nothing is at no distance.
    plates.radius[child] = triangles.empty() ? -std::numeric_limits<float>::infinity()
                                             : static_cast<float>(std::sqrt(radius_squared) + margin);
}

void NearestSurface::look_at(std::uint32_t slot, const glm::dvec3& point, Best& best) const {
    const Triangle& t = triangles_[slot];
    const glm::dvec3 ap = point - t.a;
    const double ab_ap = glm::dot(t.ab, ap);
    const double ac_ap = glm::dot(t.ac, ap);
    const auto offer = [&](double v, double w) {
        const glm::dvec3 away = ap - (v * t.ab + w * t.ac);
        const double distance = glm::dot(away, away);
        if (distance < best.distance_squared ||
            (distance == best.distance_squared && t.number < triangles_[best.slot].number)) {
            best = {distance, slot, v, w};
        }
    };
    const auto offer_ab = [&] { offer(clamp_01(ab_ap * t.per_ab), 0.0); };
    const auto offer_ac = [&] { offer(0.0, clamp_01(ac_ap * t.per_ac)); };
    const auto offer_bc = [&] {
        const double along = clamp_01(glm::dot(ap - t.ab, t.ac - t.ab) * t.per_bc);
        offer(1.0 - along, along);
    };
    // The foot of the point on the triangle's plane is a + v·ab + w·ac.
    const double v = (t.ac_ac * ab_ap - t.ab_ac * ac_ap) * t.per_area;
    const double w = (t.ab_ab * ac_ap - t.ab_ac * ab_ap) * t.per_area;
    const bool is_inside = v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t.per_area > 0.0;
    if (t.is_thin) {  // v and w are not to be relied on, but any place is a place.
        if (is_inside) offer(v, w);
        offer_ab();
        offer_ac();
        offer_bc();
        return;
    }
    if (is_inside) return offer(v, w);
    // What is nearest is on a side that the foot is beyond.
    if (w < 0.0) offer_ab();
    if (v < 0.0) offer_ac();
    if (v + w > 1.0) offer_bc();
}

std::array<float, 4> NearestSurface::Plates::distances(const glm::vec3& point) const {
    std::array<float, 4> result;
    for (std::size_t i = 0; i < 4; ++i) {
        const float x = point.x - center[0][i];
        const float y = point.y - center[1][i];
        const float z = point.z - center[2][i];
        const float squared = x * x + y * y + z * z;
        const float along = x * normal[0][i] + y * normal[1][i] + z * normal[2][i];
        const float across_squared = squared - along * along - kLost * squared;
        const float across = positive(std::sqrt(positive(across_squared)) - radius[i]);
        const float above = positive(std::abs(along) - height[i]);
        result[i] = above * above + across * across;
    }
    return result;
}

NearestSurface::Best NearestSurface::search(const glm::dvec3& point, std::uint32_t start) const {
    Best best{std::numeric_limits<double>::infinity(), start, 0.0, 0.0};
    look_at(start, point, best);
    const auto look_at_leaf = [&](std::size_t leaf) {
        const std::size_t end = first_triangle(leaf + 1);
        for (std::size_t slot = first_triangle(leaf); slot < end; ++slot) {
            look_at(static_cast<std::uint32_t>(slot), point, best);
        }
    };
    struct Branch {
        float distance;
        std::uint32_t node;
    };
    // Three of each level's four wait while the nearest is looked at; 4^16 leaves are more than there can be triangles.
    std::array<Branch, 3 * 16 + 4> waiting;
    std::size_t size = 0;
    waiting[size++] = {0.0f, 0};
    const glm::vec3 p(point - center_);
    auto reach = static_cast<float>(kReach * best.distance_squared);
    while (size > 0) {
        const Branch branch = waiting[--size];
        if (branch.distance > reach) continue;
        if (branch.node >= inner_count_) {
            look_at_leaf(branch.node - inner_count_);
            reach = static_cast<float>(kReach * best.distance_squared);
            continue;
        }
        const Plates& plates = plates_[branch.node];
        const std::array<float, 4> distances = plates.distances(p);
        // The nearest last, so that it is next.
        const std::size_t begin = size;
        for (std::uint32_t i = 0; i < 4; ++i) {
            if (distances[i] > reach) continue;
            std::size_t at = size++;
            for (; at > begin && waiting[at - 1].distance < distances[i]; --at) waiting[at] = waiting[at - 1];
            waiting[at] = {distances[i], 4 * branch.node + 1 + i};
        }
    }
    return best;
}

SurfacePoint NearestSurface::place(const Best& best) const {
    const Source& source = sources_[triangles_[best.slot].number];
    // Rounding may leave less than nothing for the first corner.
    const double rest = 1.0 - best.v - best.w;
    return {source.face, source.corners, {rest > 0.0 ? rest : 0.0, best.v, best.w}, best.distance_squared};
}

void NearestSurface::nearest(std::span<const glm::dvec3> points, std::span<SurfacePoint> places) const {
    std::uint32_t start = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Best best = search(points[i], start);
        start = best.slot;
        places[i] = place(best);
    }
}

SurfacePoint NearestSurface::nearest_of_all(const glm::dvec3& point) const {
    Best best{std::numeric_limits<double>::infinity(), 0, 0.0, 0.0};
    for (std::uint32_t slot = 0; slot < triangles_.size(); ++slot) look_at(slot, point, best);
    return place(best);
}

}  // namespace xorvox
