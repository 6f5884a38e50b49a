// Colours of PLY, OBJ and glTF files, as read_scene() gives them.
#include <glm/geometric.hpp>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/encode_image.h"
#include "tests/unit/io/glb.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/elementary.h"
#include "voxelizer/io/obj_colors.h"
#include "voxelizer/io/scene.h"

using namespace xorvox;

namespace {

float linear(double srgb) {
    return elementary::linear_from_srgb(static_cast<float>(srgb));
}

std::string ply(const std::string& type, const std::string& red, const std::string& first, const std::string& others) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty " +
           type + " " + red + "\nproperty " + type + " green\nproperty " + type +
           " blue\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0 " + first + "\n1 0 0 " +
           others + "\n0 1 0 " + others + "\n3 2 0 1\n";
}

io::Scene scene_of(const std::string& path) {
    auto scene = io::read_scene(path);
    INFO((scene ? "" : scene.error().message));
    REQUIRE(scene);
    return std::move(*scene);
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0.25 0.75\nvt 1 0\nmtllib a.mtl\n";

}  // namespace

TEST_CASE("colors: vertex colours of a PLY are sRGB, of eight bits or 0 to 1, and follow the corners") {
    const TempFolder folder;
    put(folder / "a.ply", ply("uchar", "red", "255 0 51", "0 128 255"));
    const io::Scene scene = scene_of(folder / "a.ply");
    REQUIRE(scene.colors.corner_colors.size() == 3);
    CHECK(scene.colors.corner_colors[1] == glm::vec3(1.0f, 0.0f, linear(51 / 255.0)));
    CHECK(scene.colors.corner_colors[0] == glm::vec3(0.0f, linear(128 / 255.0), 1.0f));
    put(folder / "b.ply", ply("float", "red", "1 0 0.5", "0 0 0"));
    CHECK(scene_of(folder / "b.ply").colors.corner_colors[1].b == linear(0.5));
    put(folder / "c.ply", ply("ushort", "red", "65535 0 0", "0 0 0"));
    CHECK(scene_of(folder / "c.ply").colors.corner_colors[1].r == 1.0f);
    put(folder / "d.ply", ply("uchar", "quality", "255 0 51", "0 128 255"));
    CHECK(scene_of(folder / "d.ply").colors.is_white());
}

TEST_CASE("colors: a colour that cannot be costs the colours, not the shape") {
    const TempFolder folder;
    put(folder / "a.ply", ply("float", "red", "0 0 0", "0 2 0"));
    const io::Scene scene = scene_of(folder / "a.ply");
    CHECK(scene.mesh.positions.size() == 3);
    CHECK(scene.colors.is_white());
    CHECK_THAT(scene.colors_fault, contains("a.ply: line 14: entry 1 of element 'vertex' has a colour beyond"));
    put(folder / "a.obj", "v 0 0 0 1 1 7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK_THAT(scene_of(folder / "a.obj").colors_fault, contains("a.obj: vertex 1 has a colour that is not in 0 … 1"));
}

TEST_CASE("colors: an OBJ has colours at its vertices, of its materials and of their images") {
    const TempFolder folder;
    put(folder / "v.obj", "v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0 0 0 0\nf 3 2 1\n");
    const auto colors = scene_of(folder / "v.obj").colors.corner_colors;
    CHECK(colors == std::vector<glm::vec3>{{0, 0, 0}, {1, 1, 1}, {1, 0, linear(0.5)}});

    put(folder / "a.mtl",
        "newmtl red\nKa 1 1 1\nKd 1 0 0\nnewmtl a picture\nKd 0.5\nmap_Kd -clamp on -s 1 1 1 C:\\x\\p q.png\n");
    put(folder / "p q.png", encode_png(test_picture(2, 2)));
    put(folder / "a.obj", kObj + "f 1 2 3\nusemtl a picture\nf 1/1 2/2 4/-1\nusemtl red\nf 1 3 4\nf 2 3 4 1\n");
    const io::Scene scene = scene_of(folder / "a.obj");
    CHECK(scene.colors_fault.empty());
    CHECK(scene.colors.face_materials == std::vector<std::uint32_t>{0, 1, 2, 2});
    REQUIRE(scene.colors.materials.size() == 3);
    CHECK(scene.colors.materials[0].factor == glm::vec3(1.0f));
    CHECK(scene.colors.materials[1].factor == glm::vec3(linear(0.5)));
    CHECK(scene.colors.materials[1].image == 0);
    CHECK(scene.colors.materials[1].wrap_u == TextureWrap::Clamp);
    CHECK(scene.colors.materials[2].factor == glm::vec3(1, 0, 0));
    REQUIRE(scene.colors.images.size() == 1);
    CHECK(scene.colors.images[0].pixels == test_picture(2, 2).pixels);
    REQUIRE(scene.colors.corner_texcoords.size() == 13);
    CHECK(scene.colors.corner_texcoords[3] == glm::vec2(0.25f, 0.25f));
    CHECK(scene.colors.corner_texcoords[5] == glm::vec2(1.0f, 1.0f));
}

TEST_CASE("colors: material files and images that are missing or damaged are named, and cost the colours alone") {
    const TempFolder folder;
    const auto fault = [&folder](const std::string& faces) {
        put(folder / "a.obj", kObj + faces);
        const io::Scene scene = scene_of(folder / "a.obj");
        CHECK(scene.mesh.view().face_count() == 1);
        CHECK(scene.colors.is_white());
        CHECK(io::read_mesh(folder / "a.obj"));
        return scene.colors_fault;
    };
    CHECK(fault("f 1 2 3\n").empty());
    CHECK_THAT(fault("usemtl red\nf 1 2 3\n"), contains("a.mtl: cannot be read: No such file"));
    put(folder / "a.mtl", "newmtl blue\nKd 0 0 two\nnewmtl green\nmap_Kd ../../x.png\nnewmtl text\nmap_Kd a.mtl\n");
    CHECK_THAT(fault("usemtl blue\nf 1 2 3\n"), contains("'a.mtl': line 2: the colour 'two'"));
    put(folder / "a.mtl", "newmtl green\nmap_Kd ../../x.png\nnewmtl text\nmap_Kd a.mtl\n");
    CHECK_THAT(fault("usemtl red\nf 1 2 3\n"), contains("uses the material 'red', which none of its 1"));
    CHECK_THAT(fault("usemtl green\nf 1 2 3\n"), contains("'../../x.png', which leads out of the folder"));
    CHECK_THAT(fault("usemtl text\nf 1 2 3\n"), contains("a.obj: 'a.mtl': byte 0: neither a PNG nor a JPEG"));
    put(folder / "a.mtl", "newmtl red\nmap_Kd p.png\n");
    put(folder / "p.png", encode_png(test_picture(2, 2)));
    CHECK_THAT(fault("usemtl red\nf 1/1 2/2 3/7\n"), contains("a corner has texture coordinates 7 of 2"));
    CHECK_THAT(fault("vt x y\nusemtl red\nf 1/1 2/2 3/1\n"), contains("line 8: these are no texture coordinates"));
}

TEST_CASE("colors: welding leaves every corner its colour") {
    const TempFolder folder;
    put(folder / "a.obj",
        "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 0 0 0 0 0 1\nv 0 1 0 0 0 1\nv 0 0 1 0 0 1\nf 1 2 3\nf 4 5 6\n");
    const io::Scene scene = scene_of(folder / "a.obj");
    CHECK(scene.mesh.positions.size() == 4);
    CHECK(scene.colors.corner_colors[2] == glm::vec3(1, 0, 0));
    CHECK(scene.colors.corner_colors[3] == glm::vec3(0, 0, 1));
}

namespace {

// The corner of glb.h with texture coordinates (0, 0), (1, 0), (0, 1), (1, 1) and colours, and a picture in view 4.
std::string colored_glb(
    const std::string& material, const std::string& more = "",
    const std::string& primitive = "'attributes':{'POSITION':0,'TEXCOORD_0':2,'COLOR_0':3},'indices':1,'material':0") {
    const std::string picture = encode_png(test_picture(3, 2));
    const std::string binary = corner_binary() + floats({0, 0, 1, 0, 0, 1, 1, 1}) +
                               std::string(
                                   "\xff\x00\x33\x00"
                                   "\xff\xff\xff\xff"
                                   "\x00\x00\x00\x00"
                                   "\xff\x00\x00\x00",
                                   16) +
                               picture;
    return glb(
        corner_json("'nodes':[{'mesh':0}],'materials':[" + material + "]," + more + "'asset2':0",
                    ",{'buffer':0,'byteOffset':72,'byteLength':32},{'buffer':0,'byteOffset':104,'byteLength':16},"
                    "{'buffer':0,'byteOffset':120,'byteLength':" +
                        std::to_string(picture.size()) + "}",
                    ",{'bufferView':2,'componentType':5126,'count':4,'type':'VEC2'},"
                    "{'bufferView':3,'componentType':5121,'normalized':true,'count':4,'type':'VEC4'}",
                    120 + picture.size(), primitive),
        binary);
}

const std::string kPicture =
    "'images':[{'bufferView':4,'mimeType':'image/png'}],'textures':[{'source':0,'sampler':0}],"
    "'samplers':[{'wrapS':33071,'wrapT':33648}],";

}  // namespace

TEST_CASE("colors: a glTF has factors, images and colours at its vertices, in linear light") {
    const TempFolder folder;
    put(folder / "a.glb",
        colored_glb("{'pbrMetallicRoughness':{'baseColorFactor':[1,0.5,0.25,1],'baseColorTexture':{'index':0}}}",
                    kPicture));
    const io::Scene scene = scene_of(folder / "a.glb");
    CHECK(scene.colors_fault.empty());
    REQUIRE(scene.colors.materials.size() == 1);
    CHECK(scene.colors.materials[0].factor == glm::vec3(1, 0.5, 0.25));
    CHECK(scene.colors.materials[0].wrap_u == TextureWrap::Clamp);
    CHECK(scene.colors.materials[0].wrap_v == TextureWrap::Mirror);
    REQUIRE(scene.colors.images.size() == 1);
    CHECK(scene.colors.images[0].width == 3);
    REQUIRE(scene.colors.corner_texcoords.size() == 12);
    CHECK(scene.colors.corner_texcoords[1] == glm::vec2(0, 1));  // Indices 0 2 1.
    REQUIRE(scene.colors.corner_colors.size() == 12);
    CHECK(scene.colors.corner_colors[0] == glm::vec3(1.0f, 0.0f, static_cast<float>(51 / 255.0)));
    CHECK(scene.colors.corner_colors[1] == glm::vec3(0.0f));
}

TEST_CASE("colors: a glTF moves, turns and scales its texture coordinates") {
    const TempFolder folder;
    put(folder / "a.glb",
        colored_glb("{'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'extensions':{'KHR_texture_transform':"
                    "{'offset':[10,20],'rotation':1.5707963267948966,'scale':[2,3]}}}}}",
                    kPicture));
    const io::Scene scene = scene_of(folder / "a.glb");
    REQUIRE(scene.colors.corner_texcoords.size() == 12);
    const auto near = [](glm::vec2 a, glm::vec2 b) { return glm::length(a - b) < 1e-5f; };
    CHECK(near(scene.colors.corner_texcoords[0], {10, 20}));
    CHECK(near(scene.colors.corner_texcoords[2], {10, 18}));  // (1, 0): counterclockwise, to where v is less.
    CHECK(near(scene.colors.corner_texcoords[1], {13, 20}));  // (0, 1)
}

TEST_CASE("colors: what is wrong with a glTF's colours is named, and its shape is read") {
    const TempFolder folder;
    const auto fault = [&folder](const std::string& file) {
        put(folder / "a.glb", file);
        const io::Scene scene = scene_of(folder / "a.glb");
        CHECK(scene.mesh.view().face_count() == 4);
        CHECK(scene.colors.is_white());
        return scene.colors_fault;
    };
    const std::string textured = "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}";
    CHECK_THAT(fault(colored_glb(textured, "'images':[{'uri':'none.png'}],'textures':[{'source':0}],")),
               contains("none.png: cannot be read"));
    CHECK_THAT(fault(colored_glb(textured, "'images':[{'uri':'../a.png'}],'textures':[{'source':0}],")),
               contains("leads out of the folder"));
    CHECK_THAT(fault(colored_glb(textured, "'images':[{'bufferView':0}],'textures':[{'source':0}],")),
               contains("image 0: byte 0: neither a PNG nor a JPEG"));
    CHECK_THAT(fault(colored_glb(textured, "'images':[{'bufferView':4}],'textures':[{'source':5}],")),
               contains("texture 0: its image"));
    CHECK_THAT(fault(colored_glb(textured)), contains("texture 0 of a file with 0"));
    CHECK_THAT(fault(colored_glb("{'pbrMetallicRoughness':{'baseColorFactor':[1,7,0,1]}}")),
               contains("baseColorFactor has 7"));
    CHECK_THAT(fault(colored_glb("{}", "", "'attributes':{'POSITION':0},'indices':1,'material':1")),
               contains("material 1 of a file with 1"));
    CHECK_THAT(fault(colored_glb("{}", "", "'attributes':{'POSITION':0,'COLOR_0':1},'indices':1,'material':0")),
               contains("accessor 1 has 12 elements"));
    CHECK_THAT(fault(colored_glb(textured, kPicture, "'attributes':{'POSITION':0},'indices':1,'material':0")),
               contains("no texture coordinates"));
}
