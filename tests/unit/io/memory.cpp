// Small files that ask for more memory than there is.
#include "voxelizer/io/memory.h"

#include "tests/unit/io/contains.h"
#include "tests/unit/io/memory_limit.h"
#include "tests/unit/io/volume_bytes.h"
#include "tests/unit/io/volume_hostile.h"
#include "voxelizer/io/volume_reader.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define XORVOX_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define XORVOX_SANITIZED 1
#endif
#endif

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("memory: more than the machine has is refused, and less is not") {
    CHECK(io::check_memory(1, "file"));
    const auto refused = io::check_memory(std::uint64_t{1} << 60, "file");
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, contains("file: its voxels need 1099511627776 MiB of memory and there are"));
}

TEST_CASE("memory: volumes are refused before their values are there") {
#ifdef XORVOX_SANITIZED
    XORVOX_SKIP("a sanitizer's shadow memory does not fit into a limit");
#else
    // The header tells 2³⁰ voxels, as many as these bytes could become.
    const std::string packed(std::size_t{1} << 21, 'x');
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1024 1024 1024\nencoding: gzip\n\n";
    Nifti1 nifti(2);
    for (const std::size_t at : {42u, 44u, 46u}) nifti.put<std::int16_t>(at, 1024);
    std::string binvox = "#binvox 1\ndim 1020 1024 1024\ndata\n";
    const std::size_t runs = std::size_t{1020} * 1024 * 1024 / 255;
    for (std::size_t n = 0; n < runs; ++n) binvox += std::string_view("\0\xff", 2);
    const MemoryLimit limit(rlim_t{2} << 30);
    const auto needs = [](int mib) { return contains("file: its voxels need " + std::to_string(mib) + " MiB"); };
    CHECK_THAT(refusal([](auto bytes, auto source) { return io::parse_nrrd(bytes, source); }, head + packed),
               needs(5120));
    CHECK_THAT(refusal(io::parse_nifti, gzip(nifti.bytes()) + packed), needs(5120));
    CHECK_THAT(refusal(io::parse_binvox, binvox), needs(4080));
#endif
}
