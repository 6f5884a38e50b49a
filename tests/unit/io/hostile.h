// What every parser owes to bytes that nobody vouches for.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>

#include "tests/catch.h"
#include "voxelizer/error.h"
#include "voxelizer/mesh.h"

using Parse = std::function<xorvox::Expected<xorvox::Mesh>(std::string_view bytes, std::string_view source)>;

inline bool is_sound(const xorvox::Mesh& mesh) {
    if (mesh.view().face_count() == 0 || validate(mesh.view()) != xorvox::Status::Ok) return false;
    for (std::size_t r = 0; r < mesh.view().ring_count(); ++r) {
        if (mesh.view().ring(r).size() < 3) return false;
    }
    for (const glm::dvec3& p : mesh.positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
    }
    return true;
}

/// A mesh that is sound, or one line that begins with the name of the file.
inline bool is_mesh_or_message(const Parse& parse, std::string_view bytes) {
    const auto mesh = parse(bytes, "file");
    if (mesh) return is_sound(*mesh);
    const std::string& message = mesh.error().message;
    return message.starts_with("file: ") && message.find('\n') == std::string::npos;
}

/// The message that `bytes` are refused with; empty if they are not.
inline std::string refusal(const Parse& parse, std::string_view bytes) {
    const auto mesh = parse(bytes, "file");
    return mesh ? std::string() : mesh.error().message;
}

/// Cuts `file` at every length, and changes, doubles and removes bytes of it at random.
inline void check_hostile_variants(const Parse& parse, const std::string& file) {
    for (std::size_t length = 0; length <= file.size(); ++length) {
        // A copy of its own, so that a sanitizer sees reads beyond the end.
        const std::string cut = file.substr(0, length);
        INFO("cut at " << length);
        REQUIRE(is_mesh_or_message(parse, cut));
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
        REQUIRE(is_mesh_or_message(parse, mutant));
    }
    for (int round = 0; round < 300; ++round) {
        std::string noise(1 + below(200), '\0');
        for (char& c : noise) c = static_cast<char>(below(256));
        REQUIRE(is_mesh_or_message(parse, noise));
    }
}
