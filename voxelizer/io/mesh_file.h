// Mesh files: strict readers for PLY, STL, OBJ and glTF 2.0, and by another program the rarer formats (see
// voxelizer/io/foreign_mesh.h). voxelizer/io/scene.h reads their colours and animations, too; docs/formats.md is for
// users.
//
// Strict means: a file is either read whole and as it was meant, or refused with one line that names the file, the line
// (text) or byte offset (binary), what was found and what to do. Nothing is guessed, clamped or skipped in silence.
// Refused in every format: numbers that are not finite or too large for a double (1e999), vertex numbers that no vertex
// has, polygons of fewer than three corners, files cut short, anything after the end, files without faces, files of
// more than kMaxMeshFileBytes. No count in a header is believed, and no memory taken for it, before the bytes can be
// there. Numbers are read as doubles whatever the locale. Polygons stay polygons: the mesh has a ring table unless all
// are triangles.
//
// Thread safety: all functions may run at the same time; nothing is shared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/mesh.h"

namespace xorvox::io {

/// The longest mesh file that is read: 4 GiB less one byte. Every vertex and every corner takes at least one byte of
/// its file, so vertex numbers and ring tables fit their 32 bits.
inline constexpr std::uint64_t kMaxMeshFileBytes = 0xffff'ffff;

/// Which axis of the file points up. In xorvox it is z; the mesh is turned, never mirrored.
enum class UpAxis : std::uint8_t {
    Z,  ///< As it is.
    Y,  ///< (x, y, z) becomes (x, -z, y), a quarter turn about x.
    X,  ///< (x, y, z) becomes (y, z, x), a third of a turn about the diagonal.
};

struct MeshReadOptions {
    double scale = 1.0;  ///< Multiplies every coordinate; finite and positive. See unit_in_mm().
    /// None: what the format defines, y for glTF, z for PLY, STL and OBJ, which define nothing.
    std::optional<UpAxis> up;
    /// The program that reads the rarer formats, xorvox-import; empty: they are refused.
    std::string import_program;
};

/// Millimetres in the unit called `name`: mm, cm, m, in or ft. Another name is an error that lists these.
Expected<double> unit_in_mm(std::string_view name);

/// The axis called `name`: x, y or z. Another name is an error that lists these.
Expected<UpAxis> up_axis(std::string_view name);

/// Reads the mesh file at `path`, scales and turns it, and welds it (voxelizer/io/weld.h). A regular file or a pipe,
/// read once from its beginning to its end. What decides the format: the extension of a rarer format, the first line
/// of a PLY, the magic of a GLB, the size of a binary STL (84 + 50 × its count of triangles, whatever its header says),
/// then the extension .ply, .stl, .obj, .gltf or .glb, then the word "solid" of a text STL. The mesh of a glTF is its
/// scene at rest. Errors as at the head of this file, with the path as printable_name() has it
/// (voxelizer/io/file_name.h), and: `path` missing, unreadable, a directory or a device; a format that is not known;
/// options out of range; a coordinate beyond a double after scaling; out of memory.
Expected<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options = {});

/// The parsers that read_mesh() uses, on bytes in memory. `source` is the name that errors begin with. The mesh is as
/// in the file: not welded, unused vertices kept.
///
/// PLY 1.0: ascii, binary_little_endian and binary_big_endian. Element `vertex` has scalar properties x, y and z of any
/// type, element `face` a list vertex_indices or vertex_index of integers; all other elements and properties are
/// skipped. In ascii every entry of an element has a line of its own; empty lines are passed over. Triangle strips are
/// not read.
Expected<Mesh> parse_ply(std::string_view bytes, std::string_view source);

/// STL: binary when the size is 84 + 50 × the count at byte 80, else text when it begins with "solid". Normals, colours
/// and names are not looked at (real files have nonsense there); keywords in either case; several solids follow each
/// other. No topology in the file: three vertices a triangle.
Expected<Mesh> parse_stl(std::string_view bytes, std::string_view source);

/// Wavefront OBJ. Read: `v x y z` (followed by nothing, a weight, or a colour of three or four numbers) and `f` with
/// corners v, v/vt, v//vn or v/vt/vn, counted from 1, or from the last vertex backward when negative; a face may come
/// before its vertices. Passed over, as far as the shape goes: o g s vt vn vp l p usemtl mtllib and the display
/// attributes mg, lod, usemap, maplib, bevel, c_interp, d_interp, shadow_obj, trace_obj. Also taken, because real files
/// have them: comments after data, a backslash at the end of a line of data, a byte order mark. Any other keyword
/// (curves, surfaces, calls) is refused: to ignore it would lose geometry.
Expected<Mesh> parse_obj(std::string_view bytes, std::string_view source);

}  // namespace xorvox::io
