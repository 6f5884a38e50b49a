// GLB files made in memory.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>

inline void append_u32(std::string& bytes, std::uint32_t value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline std::string floats(std::initializer_list<float> values) {
    std::string bytes;
    for (const float value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return bytes;
}

inline std::string shorts(std::initializer_list<std::uint16_t> values) {
    std::string bytes;
    for (const std::uint16_t value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return bytes;
}

inline std::string glb(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string bytes = "glTF";
    append_u32(bytes, 2);
    append_u32(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size()));
    append_u32(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    append_u32(bytes, static_cast<std::uint32_t>(binary.size()));
    bytes += std::string("BIN\0", 4) + binary;
    return bytes;
}

/// `text` with single quotes as double ones, for JSON.
inline std::string json(std::string text) {
    for (char& c : text) {
        if (c == '\'') c = '"';
    }
    return text;
}

/// The corner of a cube with edges 1, 2 and 3 along x, y and z: a closed tetrahedron of volume 1, outward.
/// Buffer: 48 bytes of positions, 24 bytes of indices. View 0 and accessor 0 are the positions, 1 the indices.
inline std::string corner_binary() {
    return floats({0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}) + shorts({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
}

/// Its JSON, with `rest` instead of its nodes, which are {'mesh': 0} without; more accessors and views on request.
inline std::string corner_json(const std::string& rest = "'nodes':[{'mesh':0}]", const std::string& more_views = "",
                               const std::string& more_accessors = "", std::size_t buffer_bytes = 72,
                               const std::string& primitive = "'attributes':{'POSITION':0},'indices':1") {
    return json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':" + std::to_string(buffer_bytes) +
                "}],'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':24}" +
                more_views +
                "],'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
                "{'bufferView':1,'componentType':5123,'count':12,'type':'SCALAR'}" +
                more_accessors + "],'meshes':[{'primitives':[{" + primitive + "}]}]," + rest + "}");
}

/// The corner, red, which its animation "slide" moves along x by 5 in 2 seconds.
inline std::string moving_corner_glb() {
    const std::string binary = corner_binary() + floats({0, 2}) + floats({0, 0, 0, 5, 0, 0});
    return glb(corner_json("'nodes':[{'mesh':0}],'materials':[{'pbrMetallicRoughness':{'baseColorFactor':[1,0,0,1]}}],"
                           "'animations':[{'name':'slide','channels':[{'sampler':0,'target':{'node':0,'path':"
                           "'translation'}}],'samplers':[{'input':2,'output':3}]}]",
                           ",{'buffer':0,'byteOffset':72,'byteLength':8},{'buffer':0,'byteOffset':80,'byteLength':24}",
                           ",{'bufferView':2,'componentType':5126,'count':2,'type':'SCALAR'},"
                           "{'bufferView':3,'componentType':5126,'count':2,'type':'VEC3'}",
                           104, "'attributes':{'POSITION':0},'indices':1,'material':0"),
               binary);
}

inline std::string corner_glb(const std::string& rest = "'nodes':[{'mesh':0}]") {
    return glb(corner_json(rest), corner_binary());
}
