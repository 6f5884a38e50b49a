// The shape of glTF files; colours and motion have files of their own.
#include <glm/geometric.hpp>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/glb.h"
#include "tests/unit/io/hostile.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/mesh_report.h"
#include "voxelizer/io/parsed_model.h"

using namespace xorvox;

namespace {

Expected<Mesh> parse(std::string_view bytes, std::string_view source) {
    auto parsed = io::parse_gltf(bytes, source, io::Wanted::ShapeAndColors, io::SideFiles());
    if (!parsed) return tl::unexpected(parsed.error());
    return std::move(parsed->mesh);
}

Mesh mesh_of(const std::string& bytes) {
    auto mesh = parse(bytes, "file");
    INFO((mesh ? "" : mesh.error().message));
    REQUIRE(mesh);
    return std::move(*mesh);
}

std::string with(const std::string& from, const std::string& to, std::string text = corner_json()) {
    const std::size_t at = text.find(json(from));
    REQUIRE(at != std::string::npos);
    return glb(text.replace(at, from.size(), json(to)), corner_binary());
}

std::string refused(const std::string& bytes) {
    return refusal(parse, bytes);
}

}  // namespace

TEST_CASE("gltf: y is up unless the user says otherwise, and the mesh is welded") {
    const TempFolder folder;
    put(folder / "a.glb", corner_glb());
    const auto mesh = io::read_mesh(folder / "a.glb");
    REQUIRE(mesh);
    CHECK(mesh->positions == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 2}, {0, -3, 0}});
    const auto report = io::report(mesh->view());
    CHECK(report.closed_mod2);
    CHECK(report.signed_volume == Approx(1.0));
    const auto as_it_is = io::read_mesh(folder / "a.glb", {.scale = 1000, .up = io::UpAxis::Z});
    REQUIRE(as_it_is);
    CHECK(as_it_is->positions[2] == glm::dvec3(0, 2000, 0));
}

TEST_CASE("gltf: a buffer is in the file, in a data URI, or beside the file") {
    const TempFolder folder;
    std::string text = corner_json();
    text.replace(
        text.find(json("'byteLength':72")), 15,
        json("'byteLength':72,'uri':'data:application/"
             "octet-stream;base64,"
             "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAEBAAAACAAEAAAABAAMAAQACAAMAAgAAAAMA'"));
    CHECK(io::report(mesh_of(text).view()).signed_volume == Approx(1.0));

    const auto beside = [&](const std::string& uri) {
        std::string file = corner_json();
        file.replace(file.find(json("'byteLength':72")), 15, json("'byteLength':72,'uri':'" + uri + "'"));
        put(folder / "a.gltf", file);
        const auto mesh = io::read_mesh(folder / "a.gltf");
        return mesh ? std::string() : mesh.error().message;
    };
    put(folder / "b c.bin", corner_binary());
    CHECK(beside("b%20c.bin").empty());
    CHECK_THAT(beside("none.bin"),
               contains("a.gltf: names a file that it needs: ") && contains("none.bin: cannot be read"));
    CHECK_THAT(beside("../b.bin"), contains("'../b.bin', which leads out of the folder"));
    CHECK_THAT(beside("x/%2e%2e/b.bin"), contains("leads out of the folder"));
    CHECK_THAT(beside("/etc/passwd"), contains("is an absolute path"));
    CHECK_THAT(beside("http://a/b.bin"), contains("is no file"));
    CHECK_THAT(beside("."), contains("is no regular file"));
    put(folder / "short.bin", corner_binary().substr(0, 70));
    CHECK_THAT(beside("short.bin"), contains("a.gltf: is no sound glTF 2.0") && contains("70"));
    CHECK_THAT(refused(corner_json("'nodes':[{'mesh':0}]")), contains("file: "));
}

TEST_CASE("gltf: strips and fans become triangles, points and lines are passed over") {
    const auto primitive = [](const std::string& text) {
        return glb(corner_json("'nodes':[{'mesh':0}]", "", "", 72, text), corner_binary());
    };
    using List = std::vector<std::uint32_t>;
    CHECK(mesh_of(primitive("'attributes':{'POSITION':0},'mode':5")).indices == List{0, 1, 2, 1, 3, 2});
    CHECK(mesh_of(primitive("'attributes':{'POSITION':0},'mode':6")).indices == List{1, 2, 0, 2, 3, 0});
    CHECK(mesh_of(primitive("'attributes':{'POSITION':0},'mode':1},{'attributes':{'POSITION':0},'mode':5"))
              .indices.size() == 6);
    CHECK_THAT(refused(primitive("'attributes':{'POSITION':0},'mode':0")),
               contains("no triangles, but points or lines"));
    CHECK_THAT(refused(primitive("'attributes':{'POSITION':0},'mode':7")), contains("mode 7"));
    CHECK_THAT(refused(primitive("'attributes':{'POSITION':0}")), contains("4 corners, which are no whole triangles"));
    CHECK_THAT(refused(primitive("'attributes':{'NORMAL':0}")), contains("mesh 0 primitive 0: without POSITION"));
}

TEST_CASE("gltf: nodes move, turn, scale and mirror their meshes, one after the other") {
    const Mesh mesh =
        mesh_of(corner_glb("'nodes':[{'children':[1],'translation':[10,0,0]},"
                           "{'mesh':0,'rotation':[0,0,0.7071067811865476,0.7071067811865476],'scale':[2,2,2]}]"));
    CHECK(glm::length(mesh.positions[1] - glm::dvec3(10, 2, 0)) < 1e-12);
    CHECK(glm::length(mesh.positions[2] - glm::dvec3(6, 0, 0)) < 1e-12);
    const Mesh mirrored = mesh_of(corner_glb("'nodes':[{'mesh':0,'matrix':[-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}]"));
    CHECK(mirrored.positions[1] == glm::dvec3(4, 6, 7));
    CHECK(io::report(mirrored.view()).signed_volume == Approx(1.0));
}

TEST_CASE("gltf: the scene that the file chooses is read, else the first, else every node") {
    const std::string nodes = "'nodes':[{'mesh':0},{'mesh':0,'translation':[5,0,0]}]";
    CHECK(mesh_of(corner_glb(nodes)).positions.size() == 8);
    CHECK(mesh_of(corner_glb(nodes + ",'scenes':[{'nodes':[0]},{'nodes':[1]}]")).positions[0].x == 0.0);
    CHECK(mesh_of(corner_glb(nodes + ",'scenes':[{'nodes':[0]},{'nodes':[1]}],'scene':1")).positions[0].x == 5.0);
    CHECK_THAT(refused(corner_glb(nodes + ",'scenes':[{'nodes':[0]}],'scene':1")),
               contains("scene 1 of a file with 1"));
    CHECK_THAT(refused(corner_glb(nodes + ",'scenes':[{'nodes':[2]}]")), contains("node 2 of a file with 2"));
    CHECK_THAT(refused(corner_glb(nodes + ",'scenes':[{'nodes':[]}]")), contains("its scene has no triangles"));
}

TEST_CASE("gltf: nodes that hang on themselves or on two others are refused, long chains are read") {
    CHECK_THAT(refused(corner_glb("'nodes':[{'mesh':0,'children':[1]},{'children':[0]}],'scenes':[{'nodes':[0]}]")),
               contains("node 0 hangs on two nodes, or on itself"));
    CHECK_THAT(refused(corner_glb("'nodes':[{'mesh':0},{'children':[0]},{'children':[0]}]")),
               contains("node 0 hangs on"));
    std::string chain = "'nodes':[{'mesh':0}";
    for (int n = 1; n < 100'000; ++n) chain += ",{'children':[" + std::to_string(n - 1) + "]}";
    CHECK(mesh_of(corner_glb(chain + "]")).positions.size() == 4);
}

TEST_CASE("gltf: sparse and normalized accessors, and strides") {
    // A view of the indices' bytes after the positions: vertex 1 is replaced by (7, 8, 9).
    std::string binary = corner_binary() + shorts({1, 0}) + floats({7, 8, 9});
    std::string text = corner_json(
        "'nodes':[{'mesh':0}]",
        ",{'buffer':0,'byteOffset':72,'byteLength':2},{'buffer':0,'byteOffset':76,'byteLength':12}", "", 88);
    const std::string plain = json("'count':4,'type':'VEC3'");
    text.replace(text.find(plain), plain.size(),
                 json("'count':4,'type':'VEC3','sparse':{'count':1,'indices':{'bufferView':2,'componentType':5123},"
                      "'values':{'bufferView':3}}"));
    CHECK(mesh_of(glb(text, binary)).positions[1] == glm::dvec3(7, 8, 9));
    const std::string outside = glb(text, corner_binary() + shorts({4, 0}) + floats({7, 8, 9}));
    CHECK_THAT(refused(outside), contains("accessor 0 (sparse): element 4 of 4"));

    // The first 48 bytes as four vertices of signed shorts, 12 bytes apart.
    std::string quantized = corner_json();
    const std::string as_floats = json("'bufferView':0,'componentType':5126");
    quantized.replace(quantized.find(as_floats), as_floats.size(),
                      json("'bufferView':0,'normalized':true,'componentType':5122"));
    const Mesh mesh = mesh_of(with("'byteLength':48}", "'byteLength':48,'byteStride':12}", quantized));
    CHECK(mesh.positions[1] == glm::dvec3(0, 0x3f80 / 32767.0, 0));
}

TEST_CASE("gltf: what points beyond its end is refused by number") {
    CHECK_THAT(refused(with("'byteLength':48", "'byteLength':480")),
               contains("buffer view 0: 480 bytes from byte 0 of a buffer of 72"));
    CHECK_THAT(refused(with("'byteOffset':48", "'byteOffset':49")), contains("buffer view 1: 24 bytes from byte 49"));
    CHECK_THAT(refused(with("'byteOffset':48", "'byteOffset':18446744073709551615")), contains("buffer view 1"));
    CHECK_THAT(refused(with("'count':4", "'count':5")), contains("accessor 0 (POSITION): 5 elements of 12 bytes"));
    CHECK_THAT(refused(with("'count':4", "'count':18446744073709551615")),
               contains("accessor 0 has 18446744073709551615"));
    CHECK_THAT(refused(with("'count':12", "'count':13")), contains("accessor 1 (indices): 13 elements"));
    CHECK_THAT(refused(with("'bufferView':0,", "'bufferView':2,")), contains("buffer view 2 of a file with 2"));
    CHECK_THAT(refused(with("'buffer':0,'byteLength':48", "'buffer':1,'byteLength':48")),
               contains("buffer 1 of a file with 1"));
    CHECK_THAT(refused(with("'POSITION':0", "'POSITION':9")), contains("accessor 9 of a file with 2"));
    CHECK_THAT(refused(with("'POSITION':0", "'POSITION':1")), contains("accessor 1 (POSITION): type"));
    CHECK_THAT(refused(with("'mesh':0", "'mesh':3")), contains("mesh 3 of a file with 1"));
    CHECK_THAT(refused(with("5126", "5130")), contains("component type 5130"));
    CHECK_THAT(refused(with("5123", "5126")), contains("not plain scalars of an unsigned type"));
    CHECK_THAT(refused(with("'byteLength':48}", "'byteLength':48,'byteStride':8}")),
               contains("a stride of 8 bytes for elements of 12"));
    std::string far = corner_binary();
    far[48] = 4;
    CHECK_THAT(refused(glb(corner_json(), far)), contains("element 0 is vertex 4 of 4"));
    far = corner_binary();
    far.replace(12, 4, floats({HUGE_VALF}));
    CHECK_THAT(refused(glb(corner_json(), far)), contains("accessor 0 (POSITION): element 1 has the value inf"));
    CHECK_THAT(refused(corner_glb("'nodes':[{'mesh':0,'scale':[1,2]}]")),
               contains("node 0: its translation, rotation"));
    CHECK_THAT(refused(corner_glb("'nodes':[{'mesh':0,'rotation':[0,0,0,0]}]")), contains("no quaternion"));
    CHECK_THAT(refused(corner_glb("'nodes':[{'mesh':0,'scale':[1e308,1e308,1e308]}]")),
               contains("beyond the range of a double"));
}

TEST_CASE("gltf: small files that would take huge memory are refused before it is taken") {
    const std::string blank =
        with("'bufferView':0,'componentType':5126,'count':4", "'componentType':5126,'count':30000000");
    CHECK_THAT(refused(blank), contains("elements without a buffer view"));
    // 600 instances of 32768 triangles, from 4 vertices.
    std::string binary = floats({0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}) + std::string(65536 * 3, '\0');
    std::string text = corner_json("'nodes':[{'mesh':0}]", "", "", binary.size());
    text.replace(text.find(json("'byteLength':24")), 15, json("'byteLength':196608"));
    text.replace(text.find(json("'count':12")), 10, json("'count':98304"));
    std::string nodes = "'nodes':[{'mesh':0}";
    for (int n = 0; n < 600; ++n) nodes += ",{'mesh':0}";
    text.replace(text.find(json("'nodes'")), std::string::npos, json(nodes + "]}"));
    CHECK_THAT(refused(glb(text, binary)), contains("more than 16777216 triangles"));
    std::string buffers = "'byteLength':72}";
    for (int b = 0; b < 16; ++b) buffers += ",{'byteLength':72}";
    CHECK_THAT(refused(with("'byteLength':72}", buffers)), contains("17 buffers in a GLB"));
    CHECK_THAT(refused("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100'000, '[')),
               contains("nested levels"));
    std::string many = "{\"a\":[";
    for (int i = 0; i < 1'100'000; ++i) many += "{},";
    CHECK_THAT(refused(many), contains("objects in its JSON text"));
}

TEST_CASE("gltf: what is no glTF 2.0, or needs more than is read, is named") {
    CHECK_THAT(refused(with("'2.0'", "'1.0'")), contains("glTF version '1.0'; only 2 is read"));
    CHECK_THAT(refused("{}"), contains("file: is no sound glTF 2.0"));
    CHECK_THAT(refused("{\"asset\""), contains("file: is no sound glTF 2.0"));
    CHECK_THAT(refused(corner_glb().substr(0, 100)), contains("bytes announced, but the file has 100"));
    CHECK_THAT(refused(corner_glb() + "x"), contains("something after its end"));
    CHECK_THAT(refused(corner_glb("'extensionsRequired':['KHR_draco_mesh_compression'],'nodes':[{'mesh':0}]")),
               contains("needs the glTF extension 'KHR_draco_mesh_compression'"));
    CHECK(mesh_of(corner_glb("'extensionsRequired':['KHR_materials_unlit'],'nodes':[{'mesh':0}]")).positions.size() ==
          4);
}

TEST_CASE("gltf: skins and morph targets leave the mesh at rest, and a note") {
    const auto parsed = io::parse_gltf(
        glb(corner_json("'nodes':[{'mesh':0,'skin':0}],'skins':[{'joints':[0],'inverseBindMatrices':0}]", "", "", 72,
                        "'attributes':{'POSITION':0},'indices':1,'targets':[{'POSITION':0}]"),
            corner_binary()),
        "file", io::Wanted::Shape, io::SideFiles());
    REQUIRE(parsed);
    CHECK(parsed->notes == std::vector<std::string>{"meshes with a skin, shown in their rest pose: 1",
                                                    "morph targets, which are not shown"});
}

TEST_CASE("gltf: cut at every length and mutated at random it gives a mesh or a message") {
    check_hostile_variants(parse, corner_glb("'nodes':[{'children':[1]},{'mesh':0,'scale':[1,1,2]}]"));
    check_hostile_variants(parse, corner_json());
}
