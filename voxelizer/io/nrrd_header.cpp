#include "voxelizer/io/nrrd_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/nrrd_names.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/volume_reader.h"

namespace xorvox::io {
namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
    }
    return result;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> result;
    TextScanner scanner(text);
    if (!scanner.next_line()) return result;
    for (auto word = scanner.word(); !word.empty(); word = scanner.word()) result.push_back(word);
    return result;
}

struct Field {
    std::string value;
    std::size_t line = 0;
};

class HeaderReader {
public:
    HeaderReader(std::string_view bytes, std::string_view source) : bytes_(bytes), source_(source) {}

    Expected<NrrdHeader> read() {
        for (const auto step : {&HeaderReader::lines, &HeaderReader::shape, &HeaderReader::format,
                                &HeaderReader::storage, &HeaderReader::placement, &HeaderReader::meaning}) {
            if (auto ok = (this->*step)(); !ok) return tl::unexpected(std::move(ok.error()));
        }
        return header_;
    }

private:
    tl::unexpected<Error> wrong(std::size_t line, std::string_view what) const {
        return fail(fmt::format("{}: line {}: {}", source_, line, what));
    }
    tl::unexpected<Error> missing(std::string_view name) const {
        return wrong(line_, fmt::format("the header has no field \"{}:\"; write the file again", name));
    }
    const Field* find(std::string_view name, std::string_view other = {}) const {
        auto at = fields_.find(name);
        if (at == fields_.end() && !other.empty()) at = fields_.find(other);
        return at == fields_.end() ? nullptr : &at->second;
    }

    // Puts the fields into fields_, up to the empty line before the data.
    Expected<void> lines() {
        std::size_t at = 0;
        for (line_ = 1; at < bytes_.size(); ++line_) {
            const std::size_t end = bytes_.find('\n', at);
            const bool whole = end != std::string_view::npos;
            std::string_view text = bytes_.substr(at, whole ? end - at : std::string_view::npos);
            if (text.ends_with('\r')) text.remove_suffix(1);
            at = whole ? end + 1 : bytes_.size();
            if (line_ == 1) {
                if (text.size() != 8 || !text.starts_with("NRRD000") || text[7] < '1' || text[7] > '5') {
                    return wrong(1, "the file does not begin with NRRD0001 to NRRD0005");
                }
            } else if (text.empty()) {
                header_.data = at;
                return {};
            } else if (auto ok = field(text); !ok) {
                return ok;
            }
        }
        header_.data = bytes_.size();  // Only a detached header may end without an empty line.
        return {};
    }

    Expected<void> field(std::string_view text) {
        if (text.starts_with('#')) return {};
        const std::size_t colon = text.find(':');
        if (colon != std::string_view::npos && text.substr(colon).starts_with(":=")) {
            // Segmentations of 3D Slicer have such keys.
            if (text.starts_with("Segment0_")) header_.labels = true;
            return {};
        }
        if (colon == std::string_view::npos || colon + 1 >= text.size() || text[colon + 1] != ' ') {
            return wrong(line_, fmt::format("{} is no field, as in \"type: float\"", quoted(text)));
        }
        std::string name = lower(text.substr(0, colon));
        if (std::ranges::find(nrrd::kPassedOver, name) != nrrd::kPassedOver.end()) return {};
        if (std::ranges::find(nrrd::kUsed, name) == nrrd::kUsed.end() &&
            std::ranges::find(nrrd::kSkips, name) == nrrd::kSkips.end()) {
            return wrong(line_, fmt::format("the field {} is not known to NRRD", quoted(name)));
        }
        Field value{std::string(trimmed(text.substr(colon + 1))), line_};
        if (!fields_.emplace(name, std::move(value)).second) {
            return wrong(line_, fmt::format("the field {} is there twice", quoted(name)));
        }
        return {};
    }

    Expected<void> shape() {
        const Field* const dimension = find("dimension");
        if (dimension == nullptr) return missing("dimension");
        if (dimension->value != "3" && dimension->value != "4") {
            return wrong(dimension->line, fmt::format("the dimension is {}; 3 is read, and 4 where the first axis is "
                                                      "colour or the last one is time",
                                                      quoted(dimension->value)));
        }
        axes_ = dimension->value == "3" ? 3 : 4;
        const Field* const sizes = find("sizes");
        if (sizes == nullptr) return missing("sizes");
        const auto texts = words(sizes->value);
        std::array<std::int64_t, 4> n{};
        for (std::size_t i = 0; i < axes_; ++i) {
            if (texts.size() != axes_ || read_number(texts[i], n[i]) != nullptr || n[i] < 1) {
                return wrong(sizes->line, fmt::format("the sizes are {}; {} numbers above 0 are needed",
                                                      quoted(sizes->value), axes_));
            }
        }
        const Field* const kinds = find("kinds");
        kinds_.assign(axes_, "");
        if (kinds != nullptr) {
            const auto names = words(kinds->value);
            if (names.size() != axes_) {
                return wrong(kinds->line, fmt::format("{} kinds for {} axes", names.size(), axes_));
            }
            for (std::size_t i = 0; i < axes_; ++i) kinds_[i] = lower(names[i]);
        }
        if (axes_ == 4 && kinds_[3] == "time") {
            if (static_cast<std::uint64_t>(n[3]) > kMaxVolumeFrames) {
                return wrong(sizes->line, fmt::format("{} frames; at most {} are read", n[3], kMaxVolumeFrames));
            }
            header_.frames = static_cast<std::uint32_t>(n[3]);
        } else if (axes_ == 4) {
            first_ = 1;
            constexpr std::string_view kColors[] = {"",          "???",     "none",       "vector", "list",
                                                    "rgb-color", "3-color", "rgba-color", "4-color"};
            if ((n[0] != 3 && n[0] != 4) || std::ranges::find(kColors, kinds_[0]) == std::end(kColors)) {
                return wrong(sizes->line,
                             fmt::format("an axis of {} {}before those of space; 3 or 4 channels of colour are read",
                                         n[0], kinds_[0].empty() ? "" : kinds_[0] + ' '));
            }
            header_.channels = static_cast<std::uint32_t>(n[0]);
        }
        const auto side = [&](std::size_t axis) { return static_cast<std::uint64_t>(n[first_ + axis]); };
        if (auto ok = check_sides(side(0), side(1), side(2), source_, fmt::format("line {}", sizes->line)); !ok) {
            return ok;
        }
        header_.nx = static_cast<std::uint32_t>(side(0));
        header_.ny = static_cast<std::uint32_t>(side(1));
        header_.nz = static_cast<std::uint32_t>(side(2));
        return {};
    }

    Expected<void> format() {
        const Field* const type = find("type");
        if (type == nullptr) return missing("type");
        const auto* known = std::ranges::find(nrrd::kTypes, lower(type->value), &nrrd::TypeName::name);
        if (known == std::end(nrrd::kTypes)) {
            return wrong(type->line, fmt::format("the type {} is not read; int8 to uint64, float and double are",
                                                 quoted(type->value)));
        }
        header_.format.type = known->type;
        if (header_.channels != 0 && known->type != NumberType::UInt8) {
            return wrong(type->line, fmt::format("colours of type {}; uint8 is read", quoted(type->value)));
        }
        const Field* const endian = find("endian");
        if (endian == nullptr) return bytes_of(known->type) == 1 ? Expected<void>() : missing("endian");
        const std::string order = lower(endian->value);
        if (order != "little" && order != "big") {
            return wrong(endian->line, fmt::format("endian is {}; it is little or big", quoted(endian->value)));
        }
        header_.format.order = order == "little" ? std::endian::little : std::endian::big;
        return {};
    }

    Expected<void> storage() {
        const Field* const encoding = find("encoding");
        if (encoding == nullptr) return missing("encoding");
        const std::string name = lower(encoding->value);
        header_.gzip = name == "gzip" || name == "gz";
        if (!header_.gzip && name != "raw") {
            return wrong(encoding->line,
                         fmt::format("the encoding {} is not read; write it as raw or gzip", quoted(encoding->value)));
        }
        if (const Field* const skip = find("line skip", "lineskip")) {
            std::int64_t value = 0;
            if (read_number(skip->value, value) != nullptr || value < 0) {
                return wrong(skip->line, fmt::format("line skip is {}; it is 0 or more", quoted(skip->value)));
            }
            header_.line_skip = static_cast<std::uint64_t>(value);
        }
        if (const Field* const skip = find("byte skip", "byteskip")) {
            if (read_number(skip->value, header_.byte_skip) != nullptr || header_.byte_skip < -1 ||
                (header_.byte_skip == -1 && header_.gzip)) {
                return wrong(skip->line,
                             fmt::format("byte skip is {}; it is 0 or more, or -1 of raw data", quoted(skip->value)));
            }
        }
        if (const Field* const file = find("data file", "datafile")) {
            if (file->value.empty() || file->value.find('%') != std::string::npos || file->value.starts_with("LIST")) {
                return wrong(file->line, fmt::format("the data file is {}; one file is read, no list or pattern",
                                                     quoted(file->value)));
            }
            header_.data_file = file->value;
        }
        return {};
    }

    // The three vectors of "(a,b,c) none (d,e,f) …", and how many there are; none for a text that is not so.
    std::optional<std::vector<glm::dvec3>> vectors(std::string_view text) const {
        std::vector<glm::dvec3> result;
        while (!(text = trimmed(text)).empty()) {
            if (text.starts_with("none")) {
                text.remove_prefix(4);
                continue;
            }
            const std::size_t end = text.find(')');
            if (!text.starts_with('(') || end == std::string_view::npos) return std::nullopt;
            std::string_view numbers = text.substr(1, end - 1);
            glm::dvec3 vector(0.0);
            for (int i = 0; i < 3; ++i) {
                const std::size_t comma = numbers.find(',');
                if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
                if (read_number(trimmed(numbers.substr(0, comma)), vector[i]) != nullptr) return std::nullopt;
                if (i < 2) numbers.remove_prefix(comma + 1);
            }
            result.push_back(vector);
            text.remove_prefix(end + 1);
        }
        return result;
    }

    Expected<glm::dvec3> space_turn() const {
        if (const Field* const space = find("space")) {
            const std::string name = lower(space->value);
            for (const nrrd::SpaceName& known : nrrd::kSpaces) {
                if (name == known.name || (name == known.abbreviation && !name.empty())) return known.turn;
            }
            return wrong(space->line, fmt::format("the space {} is not read; right-anterior-superior, "
                                                  "left-anterior-superior, left-posterior-superior, scanner-xyz and "
                                                  "3D-right-handed are",
                                                  quoted(space->value)));
        }
        const Field* const dimension = find("space dimension");
        if (dimension != nullptr && dimension->value != "3") {
            return wrong(dimension->line,
                         fmt::format("the space has {} dimensions; 3 are read", quoted(dimension->value)));
        }
        return glm::dvec3(1.0);
    }

    // Millimetres of the space's units: "mm" "mm" "mm".
    Expected<glm::dvec3> space_units() const {
        glm::dvec3 scale(1.0);
        const Field* const units = find("space units");
        if (units == nullptr) return scale;
        std::string_view text = units->value;
        for (int axis = 0; axis < 3; ++axis) {
            text = trimmed(text);
            const std::size_t end = text.starts_with('"') ? text.find('"', 1) : std::string_view::npos;
            const std::string_view unit = end == std::string_view::npos ? "?" : text.substr(1, end - 1);
            const auto* known = std::ranges::find(nrrd::kUnits, unit, [](const auto& entry) { return entry.first; });
            if (known == std::end(nrrd::kUnits)) {
                return wrong(units->line, fmt::format("the space units are {}; three of \"mm\", \"cm\", \"m\", "
                                                      "\"um\", \"nm\" and \"in\" are read, in quotes",
                                                      quoted(units->value)));
            }
            scale[axis] = known->second;
            text.remove_prefix(end + 1);
        }
        return scale;
    }

    Expected<void> placement() {
        const auto turn = space_turn();
        if (!turn) return tl::unexpected(turn.error());
        const auto units = space_units();
        if (!units) return tl::unexpected(units.error());
        const glm::dvec3 scale = *turn * *units;
        const Field* const directions = find("space directions");
        if (directions != nullptr) {
            const auto axes = vectors(directions->value);
            if (!axes || axes->size() != 3) {
                return wrong(directions->line,
                             fmt::format("the space directions are {}; three vectors are needed, as in (1,0,0), and "
                                         "none for an axis that is not of space",
                                         quoted(directions->value)));
            }
            for (int axis = 0; axis < 3; ++axis) {
                header_.to_mm[axis] = glm::dvec4((*axes)[static_cast<std::size_t>(axis)] * scale, 0.0);
            }
        } else if (auto ok = spacings(); !ok) {
            return ok;
        }
        if (const Field* const origin = find("space origin")) {
            const auto place = vectors(origin->value);
            if (!place || place->size() != 1) {
                return wrong(origin->line, fmt::format("the space origin is {}; one vector is needed, as in (1,0,0)",
                                                       quoted(origin->value)));
            }
            header_.to_mm[3] = glm::dvec4(place->front() * scale, 1.0);
        }
        SampledVolume placed;
        placed.to_mm = header_.to_mm;
        return check_placement(placed, source_, "header");
    }

    Expected<void> spacings() {
        const Field* const field = find("spacings");
        if (field == nullptr) return {};
        const auto texts = words(field->value);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double spacing = 1.0;
            const bool there = texts.size() == axes_;
            if (there && lower(texts[first_ + axis]) == "nan") continue;
            if (!there || read_number(texts[first_ + axis], spacing) != nullptr || spacing == 0.0) {
                return wrong(field->line, fmt::format("the spacings are {}; {} numbers other than 0 are needed",
                                                      quoted(field->value), axes_));
            }
            header_.to_mm[static_cast<int>(axis)][static_cast<int>(axis)] = spacing;
        }
        return {};
    }

    Expected<void> meaning() {
        if (const Field* const content = find("content")) {
            const std::string text = lower(content->value);
            if (text.find("label") != std::string::npos || text.find("segmentation") != std::string::npos) {
                header_.labels = true;
            }
        }
        return {};
    }

    std::string_view bytes_;
    std::string_view source_;
    NrrdHeader header_;
    std::map<std::string, Field, std::less<>> fields_;
    std::vector<std::string> kinds_;
    std::size_t line_ = 0;
    std::size_t axes_ = 3;
    std::size_t first_ = 0;  // The first axis of space.
};

}  // namespace

Expected<NrrdHeader> parse_nrrd_header(std::string_view bytes, std::string_view source) {
    return HeaderReader(bytes, source).read();
}

}  // namespace xorvox::io
