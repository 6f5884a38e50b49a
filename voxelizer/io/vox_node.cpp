// The nodes of a MagicaVoxel scene.
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/load.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/vox_file.h"

namespace xorvox::io {
namespace {

using Dictionary = std::map<std::string_view, std::string_view>;

class NodeReader {
public:
    NodeReader(std::string_view id, std::string_view chunk, std::string_view source, std::size_t first_byte)
        : id_(id), chunk_(chunk), source_(source), first_byte_(first_byte) {}

    Expected<void> read(VoxFile& file) {
        const std::uint32_t number = next();
        const Dictionary attributes = dictionary();
        VoxNode node;
        const auto hidden = attributes.find("_hidden");
        node.hidden = hidden != attributes.end() && hidden->second == "1";
        if (id_ == "nTRN") {
            node.children.push_back(next());
            next();  // Reserved.
            next();  // The layer.
            // Of transforms that change over time the first is taken.
            if (next() == 0) return wrong("has no frame");
            if (auto ok = place(dictionary(), node.place); !ok) return ok;
        } else {
            const std::uint32_t count = next();
            if (count > (chunk_.size() - at_) / 4) return wrong(fmt::format("announces {} entries", count));
            for (std::uint32_t n = 0; n < count && !short_; ++n) {
                (id_ == "nGRP" ? node.children : node.models).push_back(next());
                if (id_ == "nSHP") (void)dictionary();
            }
        }
        if (short_) return wrong("is cut short");
        if (!file.nodes.emplace(number, std::move(node)).second) return wrong(fmt::format("{} is there twice", number));
        return {};
    }

private:
    tl::unexpected<Error> wrong(std::string_view what) const {
        return fail(fmt::format("{}: byte {}: the node {} {}; write the file again", source_, first_byte_ + at_,
                                quoted(id_), what));
    }

    std::uint32_t next() {
        if (chunk_.size() - at_ < 4) {
            short_ = true;
            return 0;
        }
        at_ += 4;
        return load<std::uint32_t>(chunk_.data() + at_ - 4);
    }

    std::string_view text() {
        const std::uint32_t size = next();
        if (size > chunk_.size() - at_) {
            short_ = true;
            return {};
        }
        at_ += size;
        return chunk_.substr(at_ - size, size);
    }

    Dictionary dictionary() {
        Dictionary result;
        for (std::uint32_t count = next(); count > 0 && !short_; --count) {
            const std::string_view key = text();
            result[key] = text();
        }
        return result;
    }

    Expected<void> place(const Dictionary& frame, VoxPlace& place) const {
        if (const auto at = frame.find("_t"); at != frame.end()) {
            constexpr std::int64_t kMost = 1'000'000;
            TextScanner scanner(at->second);
            const bool any = scanner.next_line();
            for (int axis = 0; axis < 3; ++axis) {
                std::int64_t value = 0;
                if (!any || read_number(scanner.word(), value) != nullptr || std::abs(value) > kMost) {
                    return wrong(fmt::format("has the translation {}; three whole numbers up to {} are needed",
                                             quoted(at->second), kMost));
                }
                place.translation[axis] = static_cast<int>(value);
            }
        }
        if (const auto at = frame.find("_r"); at != frame.end()) {
            // Bits 0 and 1: the column of the first row that is not 0; 2 and 3: of the second; 4 to 6: where it is -1.
            std::int64_t bits = 0;
            const bool number = read_number(at->second, bits) == nullptr && bits >= 0 && bits < 128;
            const auto first = static_cast<int>(bits & 3);
            const auto second = static_cast<int>((bits >> 2) & 3);
            if (!number || first == 3 || second == 3 || first == second) {
                return wrong(fmt::format("has the rotation {}, which is none", quoted(at->second)));
            }
            const int columns[3] = {first, second, 3 - first - second};
            for (std::size_t row = 0; row < 3; ++row) {
                place.rows[row] = glm::ivec3(0);
                place.rows[row][columns[row]] = (bits >> (4 + row)) & 1 ? -1 : 1;
            }
        }
        return {};
    }

    std::string_view id_;
    std::string_view chunk_;
    std::string_view source_;
    std::size_t first_byte_;
    std::size_t at_ = 0;
    bool short_ = false;
};

}  // namespace

Expected<void> read_vox_node(std::string_view id, std::string_view chunk, std::string_view source,
                             std::size_t first_byte, VoxFile& file) {
    return NodeReader(id, chunk, source, first_byte).read(file);
}

}  // namespace xorvox::io
