// Foreign meshes: the rarer formats, read by assimp in a program of its own. Private to voxelizer/io.
//
// assimp believes its files: a damaged one may crash it, hang it, or make it take all memory. So xorvox-import
// (tools/import.cpp) reads the file under limits of its own and writes what it found to its standard output; here its
// time and its output are bounded, and its output is believed no more than a file (voxelizer/io/import_stream.h).
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/parsed_model.h"

namespace xorvox::io {

/// Whether `path` has the extension of a format that only the importer reads.
bool is_foreign(std::string_view path);
/// The axis that points up in such a file, as the importer gives it.
UpAxis foreign_up(std::string_view path);
/// ".3ds, .3mf, …", for messages.
std::string foreign_endings();

struct ImportLimits {
    std::chrono::milliseconds time{60'000};
    std::size_t output_bytes = std::size_t{1} << 30;
};

/// What `program` finds in the file at `path`, which errors call `name`. Starts a process and ends it before it
/// returns, whatever it does.
Expected<ParsedModel> import_foreign(const std::string& path, const std::string& name, Wanted wanted,
                                     const std::string& program, const ImportLimits& limits = {});

}  // namespace xorvox::io
