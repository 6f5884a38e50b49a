// What xorvox-import gives up before it opens a file, and the files that it opens.
#pragma once

#include <string>

#include <assimp/DefaultIOSystem.h>

namespace xorvox::tools {

/// From here on this process has bounds of memory, time and open files, and the kernel answers EPERM to whatever would
/// change a file or its name, use the network, or start a process. Kernels without such filters, in some containers,
/// and machines other than x86-64 and aarch64 have the bounds alone. Throws std::runtime_error where these cannot be
/// set.
void give_up_what_is_not_needed();

/// The files of a model: regular ones in its folder or below, no links that lead out. A model must not choose which
/// files of this machine are opened.
class ModelFiles : public Assimp::DefaultIOSystem {
public:
    explicit ModelFiles(const std::string& model_path);

    bool Exists(const char* path) const override;
    Assimp::IOStream* Open(const char* path, const char* mode) override;

private:
    bool may_open(const char* path) const;

    // Links followed.
    std::string model_;
    std::string folder_;  // Ends with a slash.
};

}  // namespace xorvox::tools
