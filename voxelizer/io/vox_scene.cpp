// The models of a MagicaVoxel file as volumes.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/volume_reader.h"
#include "voxelizer/io/vox_file.h"
#include "voxelizer/io/voxel_numbers.h"

namespace xorvox::io {
namespace {

// A shape where the scene has it.
struct Instance {
    VoxPlace place;
    const std::vector<std::uint32_t>* models;
};

glm::ivec3 turned(const VoxPlace& place, glm::ivec3 v) {
    glm::ivec3 result;
    for (std::size_t row = 0; row < 3; ++row) {
        const glm::ivec3& r = place.rows[row];
        result[static_cast<int>(row)] = r.x * v.x + r.y * v.y + r.z * v.z;
    }
    return result;
}

VoxPlace combined(const VoxPlace& outer, const VoxPlace& inner) {
    VoxPlace result;
    for (int column = 0; column < 3; ++column) {
        const glm::ivec3 v = turned(outer, {inner.rows[0][column], inner.rows[1][column], inner.rows[2][column]});
        for (int row = 0; row < 3; ++row) result.rows[static_cast<std::size_t>(row)][column] = v[row];
    }
    result.translation = turned(outer, inner.translation) + outer.translation;
    return result;
}

// The voxel where voxel `p` of a model comes to be. Models turn about their middle voxel's lower corner.
glm::ivec3 placed(const VoxPlace& place, const glm::uvec3& size, glm::ivec3 p) {
    // A centre's coordinates times two are odd, so that the halves are exact.
    const glm::ivec3 twice_centre = 2 * p + 1 - 2 * (glm::ivec3(size) / 2);
    return (turned(place, twice_centre) - 1) / 2 + place.translation;
}

struct VoxelBox {
    glm::ivec3 lower{0};
    glm::ivec3 upper{-1};
    bool operator==(const VoxelBox&) const = default;
};

VoxelBox box_of(const VoxPlace& place, const glm::uvec3& size) {
    const glm::ivec3 a = placed(place, size, glm::ivec3(0));
    const glm::ivec3 b = placed(place, size, glm::ivec3(size) - 1);
    return {glm::min(a, b), glm::max(a, b)};
}

class Scene {
public:
    Scene(const VoxFile& file, std::string_view source) : file_(file), source_(source) {}

    Expected<VolumeSequence> volumes() {
        if (file_.nodes.contains(0)) {
            if (auto ok = walk(0, {}, 0); !ok) return tl::unexpected(std::move(ok.error()));
        }
        if (auto ok = check_effort(); !ok) return tl::unexpected(std::move(ok.error()));
        if (are_apart()) return put_together();
        std::vector<std::uint32_t> order;
        for (const Instance& instance : instances_) {
            order.insert(order.end(), instance.models->begin(), instance.models->end());
        }
        if (order.empty()) {
            for (std::uint32_t n = 0; n < file_.models.size(); ++n) order.push_back(n);
        }
        return one_by_one(order);
    }

private:
    Expected<void> walk(std::uint32_t number, const VoxPlace& place, unsigned depth) {
        constexpr unsigned kMostDepth = 128;
        constexpr std::size_t kMostVisits = 65536;
        constexpr int kFurthest = 10'000'000;
        const auto at = file_.nodes.find(number);
        if (at == file_.nodes.end()) return wrong(fmt::format("there is no node {}", number));
        if (depth > kMostDepth || ++visits_ > kMostVisits) {
            return wrong(fmt::format("node {} is nested deeper than {}, or one of more than {}", number, kMostDepth,
                                     kMostVisits));
        }
        const VoxNode& node = at->second;
        if (node.hidden) return {};
        const VoxPlace here = combined(place, node.place);
        const glm::ivec3 far = glm::max(here.translation, -here.translation);
        if (std::max({far.x, far.y, far.z}) > kFurthest) return wrong(fmt::format("node {} is too far out", number));
        for (const std::uint32_t model : node.models) {
            if (model >= file_.models.size()) {
                return wrong(fmt::format("node {} shows model {} of {}", number, model, file_.models.size()));
            }
        }
        if (!node.models.empty()) instances_.push_back({here, &node.models});
        for (const std::uint32_t child : node.children) {
            if (auto ok = walk(child, here, depth + 1); !ok) return ok;
        }
        return {};
    }

    tl::unexpected<Error> wrong(std::string_view what) const {
        return fail(fmt::format("{}: scene: {}; write the file again", source_, what));
    }

    // A small file may show its models very often.
    Expected<void> check_effort() const {
        constexpr std::uint64_t kMostDrawn = std::uint64_t{1} << 30;
        std::size_t frames = instances_.empty() ? file_.models.size() : 0;
        std::uint64_t drawn = 0;
        for (const Instance& instance : instances_) {
            frames += instance.models->size();
            if (frames > kMaxVolumeFrames) break;
            for (const std::uint32_t model : *instance.models) drawn += file_.models[model].voxels.size() / 4 + 1;
        }
        // Where the scene puts shapes together, each frame draws all of them.
        if (are_apart()) drawn *= longest_shape();
        if (frames <= kMaxVolumeFrames && drawn <= kMostDrawn) return {};
        return fail(fmt::format("{}: its scene shows more than {} models, or more than {} voxels in all; show fewer",
                                source_, kMaxVolumeFrames, kMostDrawn));
    }

    std::size_t longest_shape() const {
        std::size_t longest = 0;
        for (const Instance& instance : instances_) longest = std::max(longest, instance.models->size());
        return longest;
    }

    VoxelBox box_of_instance(const Instance& instance) const {
        return box_of(instance.place, file_.models[instance.models->front()].size);
    }

    bool are_apart() const {
        return std::ranges::any_of(instances_, [&](const Instance& instance) {
            return box_of_instance(instance) != box_of_instance(instances_.front());
        });
    }

    // Empty voxels take no bytes in the file: so many are believed.
    Expected<void> check_room(std::uint64_t voxels) const {
        const std::uint64_t most = (std::uint64_t{1} << 24) + std::uint64_t{1024} * file_.bytes;
        if (voxels <= most) return {};
        return fail(
            fmt::format("{}: its models take {} voxels, nearly all empty; at most {} are read of a file of {} "
                        "bytes; move them closer together, or write fewer",
                        source_, voxels, most, file_.bytes));
    }

    SampledVolume empty_volume(const glm::uvec3& size) const {
        SampledVolume volume;
        volume.kind = VolumeKind::Labels;
        volume.nx = size.x;
        volume.ny = size.y;
        volume.nz = size.z;
        volume.to_mm[3] = glm::dvec4(0.5, 0.5, 0.5, 1.0);
        volume.values.resize(volume.voxel_count());
        volume.palette = file_.palette;
        return volume;
    }

    static void draw(const VoxModel& model, const VoxPlace* place, const glm::ivec3& lower, SampledVolume& volume) {
        for (std::size_t n = 0; n < model.voxels.size(); n += 4) {
            const auto byte = [&](std::size_t c) { return static_cast<unsigned char>(model.voxels[n + c]); };
            glm::ivec3 p(byte(0), byte(1), byte(2));
            if (place != nullptr) p = placed(*place, model.size, p) - lower;
            const glm::uvec3 at(p);
            if (byte(3) != 0) volume.values[volume.index(at.x, at.y, at.z)] = byte(3);
        }
    }

    Expected<VolumeSequence> one_by_one(const std::vector<std::uint32_t>& order) const {
        std::uint64_t voxels = 0;
        for (const std::uint32_t n : order) {
            const glm::uvec3 size = file_.models[n].size;
            voxels += std::uint64_t{size.x} * size.y * size.z;
        }
        if (auto ok = check_room(voxels); !ok) return tl::unexpected(std::move(ok.error()));
        VolumeSequence sequence;
        const glm::ivec3 middle = glm::ivec3(file_.models[order.front()].size) / 2;
        for (const std::uint32_t n : order) {
            const VoxModel& model = file_.models[n];
            SampledVolume volume = empty_volume(model.size);
            // Frames of other sizes have their middle where the first has it.
            const glm::dvec3 shift(middle - glm::ivec3(model.size) / 2);
            volume.to_mm[3] += glm::dvec4(shift, 0.0);
            draw(model, nullptr, {}, volume);
            sequence.frames.push_back(std::move(volume));
        }
        return sequence;
    }

    Expected<VolumeSequence> put_together() const {
        const std::size_t frames = longest_shape();
        VoxelBox box = box_of_instance(instances_.front());
        for (const Instance& instance : instances_) {
            for (const std::uint32_t model : *instance.models) {
                const VoxelBox own = box_of(instance.place, file_.models[model].size);
                box.lower = glm::min(box.lower, own.lower);
                box.upper = glm::max(box.upper, own.upper);
            }
        }
        const glm::uvec3 size(box.upper - box.lower + 1);
        if (auto ok = check_sides(size.x, size.y, size.z, source_, "scene"); !ok) {
            return tl::unexpected(std::move(ok.error()));
        }
        if (auto ok = check_room(std::uint64_t{size.x} * size.y * size.z * frames); !ok) {
            return tl::unexpected(std::move(ok.error()));
        }
        VolumeSequence sequence;
        for (std::size_t frame = 0; frame < frames; ++frame) {
            SampledVolume volume = empty_volume(size);
            volume.to_mm[3] += glm::dvec4(glm::dvec3(box.lower), 0.0);
            for (const Instance& instance : instances_) {
                const std::uint32_t model = (*instance.models)[std::min(frame, instance.models->size() - 1)];
                draw(file_.models[model], &instance.place, box.lower, volume);
            }
            sequence.frames.push_back(std::move(volume));
        }
        return sequence;
    }

    const VoxFile& file_;
    std::string_view source_;
    std::vector<Instance> instances_;
    std::size_t visits_ = 0;
};

}  // namespace

Expected<VolumeSequence> place_vox_models(const VoxFile& file, std::string_view source) {
    return Scene(file, source).volumes();
}

}  // namespace xorvox::io
