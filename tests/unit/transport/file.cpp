#include "transport/file.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "tests/catch.h"

namespace xorvox::transport {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// A folder of the test's own, gone at its end.
struct Folder {
    fs::path path = fs::temp_directory_path() / fmt::format("xorvox-file-{}", ::getpid());
    Folder() { fs::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
    /// Everything in it, sorted.
    Names names() const {
        Names names;
        for (const auto& entry : fs::recursive_directory_iterator(path)) {
            names.push_back(entry.path().lexically_relative(path).string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }
};

std::string read_all(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_all(const std::string& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

bool contains(const Error& error, std::string_view words) {
    return error.message.find(words) != std::string::npos;
}

/// Records packets of the given sizes.
void record(const std::string& path, std::initializer_list<std::size_t> sizes) {
    const auto writer = open_file_writer(path);
    REQUIRE(writer);
    for (const std::size_t size : sizes) REQUIRE((*writer)->send(std::vector<std::byte>(size)) == Status::Ok);
    REQUIRE(commit_file(writer->get()));
}

/// The sizes of the packets in a recording; −1 for a Corrupt.
std::vector<int> play(const std::string& path) {
    const auto reader = open_file_reader(path);
    REQUIRE(reader);
    std::vector<int> sizes;
    std::vector<std::byte> buffer(65536);
    for (;;) {
        std::size_t size = 0;
        const Status status = (*reader)->receive(buffer, size);
        if (status == Status::Closed) return sizes;
        REQUIRE((status == Status::Ok || status == Status::Corrupt));
        sizes.push_back(status == Status::Ok ? static_cast<int>(size) : -1);
    }
}

TEST_CASE("a recording that is not committed leaves nothing behind") {
    const Folder folder;
    {
        const auto writer = open_file_writer(folder.file("a.xvr"));
        REQUIRE(writer);
        REQUIRE((*writer)->send(std::vector<std::byte>(100'0)) == Status::Ok);
        REQUIRE((*writer)->flush() == Status::Ok);
        CHECK_FALSE(fs::exists(folder.file("a.xvr")));
    }
    CHECK(folder.names() == Names{});
}

TEST_CASE("an existing recording is replaced only by a whole one") {
    const Folder folder;
    const std::string path = folder.file("a.xvr");
    write_all(path, "old");
    { const auto writer = open_file_writer(path); }
    CHECK(read_all(path) == "old");
    record(path, {3});
    CHECK(play(path) == std::vector<int>{3});
    CHECK(folder.names() == Names{"a.xvr"});
}

TEST_CASE("a recording touches no file of its user but the one that was named") {
    const Folder folder;
    const std::string path = folder.file("a.xvr");
    const Names names = {"a.xvr.part", "a.xvr.tmp", "a.part", fmt::format(".xorvox-{}-0.tmp", ::getpid())};
    for (const std::string& name : names) write_all(folder.file(name), "precious");
    record(path, {3});
    for (const std::string& name : names) CHECK(read_all(folder.file(name)) == "precious");
    CHECK(folder.names().size() == names.size() + 1);
}

TEST_CASE("two recordings of one name do not mix: the one that is complete last stays") {
    const Folder folder;
    const std::string path = folder.file("a.xvr");
    const auto first = open_file_writer(path), second = open_file_writer(path);
    REQUIRE(first);
    REQUIRE(second);
    for (std::size_t i = 0; i < 3; ++i) {
        REQUIRE((*first)->send(std::vector<std::byte>(10)) == Status::Ok);
        REQUIRE((*second)->send(std::vector<std::byte>(20)) == Status::Ok);
    }
    REQUIRE(commit_file(second->get()));
    CHECK(play(path) == std::vector<int>{20, 20, 20});
    REQUIRE(commit_file(first->get()));
    CHECK(play(path) == std::vector<int>{10, 10, 10});
    CHECK(folder.names() == Names{"a.xvr"});
}

TEST_CASE("a recording follows a link and stays where it points") {
    const Folder folder;
    fs::create_directory(folder.file("there"));
    write_all(folder.file("there/real"), "old");
    fs::create_symlink("there/real", folder.file("link"));
    record(folder.file("link"), {3});
    CHECK(fs::is_symlink(folder.file("link")));
    CHECK(play(folder.file("there/real")) == std::vector<int>{3});
    CHECK(folder.names() == Names{"link", "there", "there/real"});
}

TEST_CASE("a recording's name may be without a folder") {
    const Folder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path);
    record("a.xvr", {3});
    fs::current_path(before);
    CHECK(folder.names() == Names{"a.xvr"});
}

TEST_CASE("the bytes of a recording are these") {
    const Folder folder;
    const std::string path = folder.file("a.xvr");
    const auto writer = open_file_writer(path);
    REQUIRE(writer);
    const std::byte packet[] = {std::byte{'1'}, std::byte{'2'}, std::byte{'3'}};
    REQUIRE((*writer)->send(packet) == Status::Ok);
    REQUIRE(commit_file(writer->get()));
    CHECK(read_all(path) == std::string("XORVOX\x01\n\xE7\x4C\x02\x00\xA9\x5F"
                                        "123",
                                        17));
    CHECK((*writer)->send(packet) == Status::Closed);
    CHECK(commit_file(writer->get()));
}

TEST_CASE("a truncated recording gives its whole packets, one Corrupt, and Closed") {
    const Folder folder;
    const std::string whole = folder.file("whole.xvr"), cut = folder.file("cut.xvr");
    record(whole, {10, 20});
    const std::string bytes = read_all(whole);
    const std::size_t head = 8, first = head + 16;
    REQUIRE(bytes.size() == first + 26);
    for (std::size_t length = head; length <= bytes.size(); ++length) {
        write_all(cut, std::string_view(bytes).substr(0, length));
        std::vector<int> expected;
        if (length >= first) expected.push_back(10);
        if (length == bytes.size()) {
            expected.push_back(20);
        } else if (length != head && length != first) {
            expected.push_back(-1);
        }
        CHECK(play(cut) == expected);
    }
}

TEST_CASE("a damaged place in a recording is one Corrupt and the rest is given") {
    const Folder folder;
    const std::string path = folder.file("a.xvr");
    record(path, {10, 20, 30});
    std::string bytes = read_all(path);
    bytes[8 + 16] = 'x';
    write_all(path, bytes);
    CHECK(play(path) == std::vector<int>{10, -1, 30});
}

TEST_CASE("opening a recording says what is wrong with the file") {
    const Folder folder;
    const auto missing = open_file_reader(folder.file("none"));
    REQUIRE_FALSE(missing);
    CHECK(contains(missing.error(), "none: cannot be opened: No such file"));

    const auto directory = open_file_reader(folder.path.string());
    REQUIRE_FALSE(directory);
    CHECK(contains(directory.error(), "is a directory"));

    for (const char* text : {"", "XORVOX", "XORVOX\x02\n", "ply\nformat ascii 1.0\n"}) {
        write_all(folder.file("other"), text);
        const auto other = open_file_reader(folder.file("other"));
        REQUIRE_FALSE(other);
        CHECK(contains(other.error(), "is no recording of xorvox"));
    }
}

TEST_CASE("creating a recording says what is wrong with the place") {
    const Folder folder;
    const auto refusal = [](const std::string& path) {
        const auto writer = open_file_writer(path);
        REQUIRE_FALSE(writer);
        CHECK(writer.error().message.starts_with(path + ": "));
        return writer.error();
    };
    CHECK(contains(refusal(folder.file("no/such/folder")), "cannot be created: No such file or directory"));
    CHECK(contains(refusal(folder.path.string()), "is a directory"));
    CHECK(contains(refusal("/dev/null"), "is a device or a pipe"));
    fs::create_symlink("gone", folder.file("dangling"));
    CHECK(contains(refusal(folder.file("dangling")), "is a link to nothing"));
    fs::create_symlink("/dev/null", folder.file("null"));
    CHECK(contains(refusal(folder.file("null")), "is a device or a pipe"));
    CHECK(folder.names() == Names{"dangling", "null"});
}

TEST_CASE("a recording that cannot be completed says why and keeps nothing") {
    const Folder folder;
    const std::string path = folder.file("a.xvr");
    {
        const auto writer = open_file_writer(path);
        REQUIRE(writer);
        fs::create_directories(path);  // In the way of the name.
        const auto committed = commit_file(writer->get());
        REQUIRE_FALSE(committed);
        CHECK(contains(committed.error(), "a.xvr: cannot be written"));
    }
    CHECK(folder.names() == Names{"a.xvr"});
    CHECK(fs::is_directory(path));
}

TEST_CASE("a reader takes answers and forgets them") {
    const Folder folder;
    record(folder.file("a"), {5});
    const auto reader = open_file_reader(folder.file("a"));
    REQUIRE(reader);
    CHECK((*reader)->send(std::vector<std::byte>(30)) == Status::Ok);
    CHECK(fs::file_size(folder.file("a")) == 8 + 11);
}

}  // namespace
}  // namespace xorvox::transport
