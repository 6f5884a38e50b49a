// The images of a model, which are bounded together. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "voxelizer/error.h"
#include "voxelizer/image.h"

namespace xorvox::io {

class ModelImages {
public:
    /// The most pixels of all images of a model.
    static constexpr std::size_t kMostPixels = std::size_t{1} << 28;

    /// `source`, the model's name, begins errors.
    explicit ModelImages(std::string_view source) : source_(source) {}

    /// The number that the decoded image gets, from 0 on; an error when it could not be decoded, or there are too many
    /// pixels.
    Expected<std::uint32_t> add(Expected<Image> image) {
        if (!image) return tl::unexpected(std::move(image.error()));
        pixels_ += image->pixels.size();
        if (pixels_ > kMostPixels) {
            return fail(
                fmt::format("{}: images of more than {} pixels together; make them smaller", source_, kMostPixels));
        }
        images_.push_back(std::move(*image));
        return static_cast<std::uint32_t>(images_.size() - 1);
    }

    std::vector<Image> take() && { return std::move(images_); }

private:
    std::string_view source_;
    std::vector<Image> images_;
    std::size_t pixels_ = 0;
};

}  // namespace xorvox::io
