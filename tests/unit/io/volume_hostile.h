// What every parser of volumes owes to bytes that nobody vouches for.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <string_view>

#include <glm/matrix.hpp>

#include "tests/catch.h"
#include "voxelizer/error.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::test {

using ParseVolume = std::function<Expected<VolumeSequence>(std::string_view bytes, std::string_view source)>;

/// What SampledVolume promises.
inline bool is_sound(const SampledVolume& volume) {
    const bool colors = volume.kind == VolumeKind::Colors;
    const std::size_t count = volume.voxel_count();
    const bool sides = volume.nx >= 1 && volume.ny >= 1 && volume.nz >= 1 &&
                       std::max({volume.nx, volume.ny, volume.nz}) <= SampledVolume::kMostSide &&
                       count <= SampledVolume::kMostVoxels;
    const bool shape = volume.colors.size() == (colors ? count : 0) && volume.values.size() == (colors ? 0 : count);
    const bool values = std::all_of(volume.values.begin(), volume.values.end(), [&](float value) {
        if (volume.kind == VolumeKind::Binary) return value == 0.0f || value == 1.0f;
        if (volume.kind == VolumeKind::Labels) return value >= 0.0f && value == std::floor(value);
        return std::isfinite(value);
    });
    bool place = volume.to_mm[0][3] == 0.0 && volume.to_mm[1][3] == 0.0 && volume.to_mm[2][3] == 0.0 &&
                 volume.to_mm[3][3] == 1.0;
    const glm::dmat4 inverse = glm::inverse(volume.to_mm);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) place = place && std::isfinite(inverse[column][row]);
    }
    return sides && shape && values && place;
}

inline bool is_volume_or_message(const ParseVolume& parse, std::string_view bytes) {
    const auto sequence = parse(bytes, "file");
    if (sequence) return !sequence->frames.empty() && std::ranges::all_of(sequence->frames, is_sound);
    const std::string& message = sequence.error().message;
    return message.starts_with("file: ") && message.find('\n') == std::string::npos;
}

/// The message that `bytes` are refused with; empty if they are not.
inline std::string refusal(const ParseVolume& parse, std::string_view bytes) {
    const auto sequence = parse(bytes, "file");
    return sequence ? std::string() : sequence.error().message;
}

/// Cuts `file` at every length, which must be refused below `whole` bytes, and changes bytes of it at random.
inline void check_hostile_volume(const ParseVolume& parse, const std::string& file, std::size_t whole) {
    for (std::size_t length = 0; length <= file.size(); ++length) {
        const std::string cut = file.substr(0, length);  // A copy, so that a sanitizer sees reads beyond the end.
        INFO("cut at " << length);
        REQUIRE(is_volume_or_message(parse, cut));
        if (length < whole) REQUIRE(!refusal(parse, cut).empty());
    }
    std::mt19937 random(20);
    const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    for (int round = 0; round < 3000; ++round) {
        std::string mutant = file;
        for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
            const std::size_t at = below(mutant.size());
            switch (below(4)) {
                case 0: mutant[at] = static_cast<char>(below(256)); break;
                case 1: mutant[at] = static_cast<char>(mutant[at] ^ (1 << below(8))); break;
                case 2: mutant.insert(at, mutant, below(mutant.size()), 1 + below(16)); break;
                default: mutant.erase(at, 1 + below(8)); break;
            }
            if (mutant.empty()) mutant = "x";
        }
        INFO("round " << round);
        REQUIRE(is_volume_or_message(parse, mutant));
    }
}

}  // namespace xorvox::test
