#include "voxelizer/io/atomic_file.h"

#include <csignal>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/file_size_limit.h"
#include "tests/unit/io/no_unnamed_files.h"
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
        *other = std::move(*file);
    }
    CHECK(contents(folder / "a") == "old");
    CHECK(folder.names() == Names{"a"});
}

TEST_CASE("a process killed while it writes leaves no part of an atomic file") {
    const TempFolder folder;
    if (!takes_unnamed_files(folder.path().c_str())) XORVOX_SKIP("the file system has no unnamed files");
    int pipe[2];
    REQUIRE(::pipe(pipe) == 0);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        auto file = io::AtomicFile::create(folder / "a");
        const bool ok = file && file->write("new");
        if (::write(pipe[1], ok ? "y" : "n", 1) == 1) ::pause();
        ::_exit(1);
    }
    char written = 'n';
    const ssize_t got = ::read(pipe[0], &written, 1);
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(pipe[0]);
    ::close(pipe[1]);
    REQUIRE(got == 1);
    CHECK(written == 'y');
    CHECK(WIFSIGNALED(status));
    CHECK(folder.names() == Names{});
}

TEST_CASE("an atomic file where the file system has no unnamed files") {
    const TempFolder folder;
    put(folder / "old", "old");
    Names before;
    Names while_writing;
    bool all_written = false;
    const bool ran = run_without_unnamed_files([&] {
        auto file = io::AtomicFile::create(folder / "given up");
        auto other = io::AtomicFile::create(folder / "given up, too");
        if (!file || !other) return;
        before = folder.names();
        *other = std::move(*file);
        while_writing = folder.names();
        all_written = io::write_file_atomically(folder / "old", "new") && io::write_file_atomically(folder / "a", "b");
    });
    if (!ran) XORVOX_SKIP("this kernel filters no system calls for us");
    CHECK(before.size() == 3);
    CHECK(while_writing.size() == 2);
    CHECK(all_written);
    CHECK(contents(folder / "old") == "new");
    CHECK(contents(folder / "a") == "b");
    CHECK(folder.names() == Names{"a", "old"});
}

TEST_CASE("an atomic file has the permissions of any new file") {
    const TempFolder folder;
    put(folder / "usual", "");
    put(folder / "replaced", "");
    REQUIRE(io::write_file_atomically(folder / "new", ""));
    REQUIRE(io::write_file_atomically(folder / "replaced", ""));
    for (const char* name : {"new", "replaced"}) {
        CHECK(std::filesystem::status(folder / name).permissions() ==
              std::filesystem::status(folder / "usual").permissions());
    }
}

TEST_CASE("a file that appears while an atomic file of its name is written is replaced") {
    const TempFolder folder;
    auto file = io::AtomicFile::create(folder / "a");
    REQUIRE(file);
    REQUIRE(file->write("new"));
    put(folder / "a", "meanwhile");
    REQUIRE(file->commit());
    CHECK(contents(folder / "a") == "new");
    CHECK(folder.names() == Names{"a"});
}

TEST_CASE("a name that no file can have is refused before anything is written") {
    const TempFolder folder;
    CHECK_FALSE(io::AtomicFile::create(""));
    CHECK_FALSE(io::AtomicFile::create(folder / std::string(300, 'x')));
}

TEST_CASE("messages about files of odd names are one line") {
    const TempFolder folder;
    CHECK_THAT(refusal(folder / "no\nfolder\x1b/a\x7f"),
               contains("/no\\x0afolder\\x1b/a\\x7f: cannot be created: No such file or directory"));
    CHECK_THAT(refusal(folder / "n\u00f6\u0085/\xc2"), contains("/n\u00f6\\x85/\xc2: cannot be created"));
    CHECK_THAT(io::write_file_atomically(folder / "a/b\nc", "").error().message, contains("/a/b\\x0ac: "));
    REQUIRE(io::write_file_atomically(folder / "a\nb", "new"));
    CHECK(contents(folder / "a\nb") == "new");
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
    CHECK_THAT(refusal(""), contains("the name of the file to write is empty"));
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
