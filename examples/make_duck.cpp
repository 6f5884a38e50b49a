// make_duck OUT.ply: writes the demo model. examples/duck.ply is what it wrote.
#include <cstdio>

#include "examples/duck.h"
#include "voxelizer/io/atomic_file.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: make_duck OUT.ply\n", stderr);
        return 2;
    }
    if (const auto ok = xorvox::io::write_file_atomically(argv[1], xorvox::examples::duck_ply()); !ok) {
        std::fprintf(stderr, "%s\n", ok.error().message.c_str());
        return 2;
    }
    return 0;
}
