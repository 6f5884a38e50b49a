// An importer that does what its file says: how import_foreign() meets a program that fails in every way.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <unistd.h>

#include "voxelizer/io/import_stream.h"

using namespace xorvox;

int main(int, char** arguments) {
    std::string word;
    std::ifstream(arguments[1]) >> word;
    if (word == "hang") {
        for (;;) ::pause();
    }
    if (word == "hang-silently") {
        ::close(STDOUT_FILENO);
        for (;;) ::pause();
    }
    if (word == "crash") std::raise(SIGSEGV);
    if (word == "killed") std::raise(SIGKILL);
    if (word == "fail") return 7;
    if (word == "flood") {
        const std::string much(1 << 16, 'x');
        while (std::fwrite(much.data(), 1, much.size(), stdout) == much.size()) {
        }
    }
    if (word == "garbage") std::fputs("Segmentation violated", stdout);
    if (word == "refuse") std::fputs(io::encode_import_error("no such\nformat").c_str(), stdout);
    if (word == "triangle" || word == "cut") {
        io::ImportedModel model;
        model.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        model.indices = {0, 1, 2};
        model.face_sizes = {3};
        model.face_materials = {0};
        model.materials.emplace_back();
        const std::string bytes = encode_import(model);
        std::fwrite(bytes.data(), 1, bytes.size() - (word == "cut" ? 1 : 0), stdout);
    }
    return 0;
}
