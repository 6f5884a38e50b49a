#include "voxelizer/io/import_stream.h"

#include <cmath>
#include <limits>
#include <random>

#include "tests/unit/io/contains.h"

using namespace xorvox;
using io::ImportedModel;

namespace {

ImportedModel model_of_everything() {
    ImportedModel model;
    model.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 2, 3}};
    model.indices = {0, 1, 2, 3, 2, 1, 0};
    model.face_sizes = {4, 3};
    model.face_materials = {1, 0};
    model.corner_colors.assign(7, glm::vec3(0.5f));
    model.corner_texcoords.assign(7, glm::vec2(0.25f, -3.0f));
    model.materials.resize(2);
    model.materials[1] = {glm::vec3(1, 0, 0), 0, TextureWrap::Mirror, TextureWrap::Clamp};
    model.images = {{true, "wood.png"}};
    model.notes = {"two animations"};
    return model;
}

std::string refused(const ImportedModel& model) {
    bool by_importer = true;
    const auto parsed = io::parse_import(encode_import(model), by_importer);
    CHECK_FALSE(by_importer);
    return parsed ? std::string() : parsed.error().message;
}

}  // namespace

TEST_CASE("import stream: what goes in comes out") {
    const ImportedModel model = model_of_everything();
    bool refused = true;
    const auto parsed = io::parse_import(encode_import(model), refused);
    REQUIRE(parsed);
    CHECK_FALSE(refused);
    CHECK(parsed->positions == model.positions);
    CHECK(parsed->indices == model.indices);
    CHECK(parsed->face_sizes == model.face_sizes);
    CHECK(parsed->face_materials == model.face_materials);
    CHECK(parsed->corner_colors == model.corner_colors);
    CHECK(parsed->corner_texcoords == model.corner_texcoords);
    REQUIRE(parsed->materials.size() == 2);
    CHECK(parsed->materials[1].factor == glm::vec3(1, 0, 0));
    CHECK(parsed->materials[1].image == 0);
    CHECK(parsed->materials[1].wrap_u == TextureWrap::Mirror);
    CHECK(parsed->materials[1].wrap_v == TextureWrap::Clamp);
    REQUIRE(parsed->images.size() == 1);
    CHECK(parsed->images[0].is_name);
    CHECK(parsed->images[0].bytes == "wood.png");
    CHECK(parsed->notes == model.notes);
}

TEST_CASE("import stream: nonsense is named") {
    const auto with = [](auto change) {
        ImportedModel model = model_of_everything();
        change(model);
        return refused(model);
    };
    CHECK(with([](auto&) {}).empty());
    CHECK_THAT(with([](auto& m) { m.positions[2].y = std::nan(""); }), contains("a vertex is not finite"));
    CHECK_THAT(with([](auto& m) { m.indices[6] = 4; }), contains("a corner has a vertex that is not there"));
    CHECK_THAT(with([](auto& m) { m.face_sizes = {5, 2}; }), contains("less than three corners"));
    CHECK_THAT(with([](auto& m) { m.face_sizes = {4, 4}; }), contains("do not have its corners"));
    CHECK_THAT(with([](auto& m) { m.face_sizes = {0xffff'ffff, 8}; }), contains("do not have its corners"));
    CHECK_THAT(with([](auto& m) { m.face_materials[0] = 2; }), contains("a material that is not there"));
    CHECK_THAT(with([](auto& m) { m.materials[0].image = 1; }), contains("an image that is not there"));
    CHECK_THAT(with([](auto& m) { m.materials[0].wrap_u = static_cast<TextureWrap>(3); }),
               contains("counts cannot be"));
}

TEST_CASE("import stream: colours that cannot be are a fault of their own") {
    const auto fault = [](auto change) {
        ImportedModel model = model_of_everything();
        change(model);
        const char* wrong = io::color_fault(model);
        return wrong ? std::string(wrong) : std::string();
    };
    CHECK(fault([](auto&) {}).empty());
    CHECK_THAT(fault([](auto& m) { m.corner_colors[3].g = 1.5f; }), contains("a vertex has a colour"));
    CHECK_THAT(fault([](auto& m) { m.corner_colors[3].g = std::nanf(""); }), contains("a vertex has a colour"));
    CHECK_THAT(fault([](auto& m) { m.corner_texcoords[3].x = HUGE_VALF; }), contains("texture coordinates"));
    CHECK_THAT(fault([](auto& m) { m.materials[1].factor.b = -1.0f; }), contains("a material has a colour"));
}

TEST_CASE("import stream: cut at every length, or changed anywhere, it gives a sound model or a message") {
    const std::string whole = encode_import(model_of_everything());
    bool refused = false;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        CHECK_FALSE(io::parse_import(whole.substr(0, length), refused));
    }
    CHECK_FALSE(io::parse_import(whole + "x", refused));
    std::mt19937 random(6);
    for (int round = 0; round < 20'000; ++round) {
        std::string mutant = whole;
        for (int change = 0; change < 3; ++change) mutant[random() % mutant.size()] = static_cast<char>(random());
        const auto model = io::parse_import(mutant, refused);
        if (!model) continue;
        for (const std::uint32_t index : model->indices) REQUIRE(index < model->positions.size());
    }
    // Counts that no bytes stand for take no memory.
    std::string huge = whole;
    for (std::size_t at = 8; at < 12; ++at) huge[at] = '\xff';
    CHECK_FALSE(io::parse_import(huge, refused));
}
