#include "voxelizer/io/atomic_file.h"

#include <optional>

#include <sys/stat.h>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/file_size_limit.h"
#include "tests/unit/io/temp_folder.h"

using namespace xorvox;

namespace {

using Names = std::set<std::string>;

std::string refusal(const std::string& path) {
    const auto written = io::write_file_atomically(path, "new");
    return written ? std::string() : written.error().message;
}

}  // namespace

TEST_CASE("an atomic file appears with its name and nothing beside it") {
    const TempFolder folder;
    REQUIRE(io::write_file_atomically(folder / "a", "hello"));
    CHECK(contents(folder / "a") == "hello");
    CHECK(folder.names() == Names{"a"});
    REQUIRE(io::write_file_atomically(folder / "a", ""));
    CHECK(contents(folder / "a").empty());
}

TEST_CASE("an atomic file is not there before it is committed") {
    const TempFolder folder;
    put(folder / "a", "old");
    auto file = io::AtomicFile::create(folder / "a");
    REQUIRE(file);
    REQUIRE(file->write("ne"));
    REQUIRE(file->write("w"));
    CHECK(contents(folder / "a") == "old");
    REQUIRE(file->commit());
    CHECK(contents(folder / "a") == "new");
}

TEST_CASE("an atomic file given up leaves the folder as it was") {
    const TempFolder folder;
    put(folder / "a", "old");
    {
        auto file = io::AtomicFile::create(folder / "a");
        auto other = io::AtomicFile::create(folder / "b");
        REQUIRE(file);
        REQUIRE(other);
        REQUIRE(file->write("new"));
        CHECK(folder.names().size() == 3);
        *other = std::move(*file);
        CHECK(folder.names().size() == 2);
    }
    CHECK(contents(folder / "a") == "old");
    CHECK(folder.names() == Names{"a"});
}

TEST_CASE("a full disk leaves the folder as it was") {
    const TempFolder folder;
    put(folder / "a", "old");
    Expected<void> written;
    {
        const FileSizeLimit limit(1000);
        written = io::write_file_atomically(folder / "a", std::string(5000, 'x'));
    }
    REQUIRE_FALSE(written);
    CHECK_THAT(written.error().message, contains("/a: cannot be written: File too large"));
    CHECK(contents(folder / "a") == "old");
    CHECK(folder.names() == Names{"a"});
}

TEST_CASE("an atomic file is refused where none can be") {
    const TempFolder folder;
    CHECK_THAT(refusal(folder.path()), contains("is a directory"));
    CHECK_THAT(refusal(folder / "no/a"), contains("no/a: cannot be created: No such file or directory"));
    put(folder / "file", "old");
    CHECK_THAT(refusal(folder / "file/a"), contains("cannot be created: Not a directory"));
    CHECK_THAT(refusal("/dev/null"), contains("is a device or a pipe"));
    CHECK_THAT(refusal(""), contains("cannot be created"));
    CHECK_THAT(refusal(folder / std::string(300, 'x')), contains("File name too long"));
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK_THAT(refusal(folder / "pipe"), contains("is a device or a pipe"));
    std::filesystem::create_symlink("pipe", folder / "link");
    CHECK_THAT(refusal(folder / "link"), contains("is a device or a pipe"));
    CHECK(folder.names() == Names{"file", "link", "pipe"});
    struct stat info {};
    REQUIRE(::stat("/dev/null", &info) == 0);
    CHECK(S_ISCHR(info.st_mode));
}

TEST_CASE("an atomic file is refused in a folder that may not be written to") {
    if (::geteuid() == 0) XORVOX_SKIP("root may write everywhere");
    const TempFolder folder;
    REQUIRE(::chmod(folder.path().c_str(), 0500) == 0);
    CHECK_THAT(refusal(folder / "a"), contains("cannot be created: Permission denied"));
    REQUIRE(::chmod(folder.path().c_str(), 0700) == 0);
}

TEST_CASE("an atomic file follows a link and refuses one to nothing") {
    const TempFolder folder;
    put(folder / "real", "old");
    std::filesystem::create_symlink("real", folder / "link");
    std::filesystem::create_symlink("gone", folder / "dangling");
    REQUIRE(io::write_file_atomically(folder / "link", "new"));
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(contents(folder / "real") == "new");
    CHECK_THAT(refusal(folder / "dangling"), contains("link to nothing"));
    CHECK(folder.names() == Names{"dangling", "link", "real"});
}

TEST_CASE("an atomic file in the working folder") {
    const TempFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const auto written = io::write_file_atomically("a", "here");
    std::filesystem::current_path(before);
    CHECK(written);
    CHECK(folder.names() == Names{"a"});
}
