#include "driver/device/pages.h"

#include <vector>

#include "tests/catch.h"

using namespace xorvox::device;

namespace {

struct Fixture {
    std::vector<std::byte> memory;
    Pages pages;
    explicit Fixture(std::uint32_t count) : memory(count * 4) { pages.init(memory, 4, count); }

    std::uint32_t accept(std::uint32_t frame, std::uint64_t due_ns) {
        const std::uint32_t page = pages.find_free();
        REQUIRE(page != Pages::kNone);
        pages.accept(page, frame, frame * 10, due_ns);
        return page;
    }
    std::uint32_t shown_frame() const { return pages.page(pages.shown()).frame; }
};

}  // namespace

TEST_CASE("pages are the caller's memory, side by side") {
    Fixture f(3);
    CHECK(f.pages.bytes(0).data() == f.memory.data());
    CHECK(f.pages.bytes(2).data() == f.memory.data() + 8);
    CHECK(f.pages.bytes(2).size() == 4);
    CHECK(f.pages.free_count() == 3);
}

TEST_CASE("a page is in use while it is pending, shown or the delta base") {
    Fixture f(3);
    const std::uint32_t first = f.accept(1, 0);
    CHECK(f.pages.free_count() == 2);
    REQUIRE(f.pages.present(0));
    CHECK(f.pages.shown() == first);
    CHECK(f.pages.base() == first);
    CHECK(f.pages.free_count() == 2);
    const std::uint32_t second = f.accept(2, 5);
    CHECK(second != first);
    CHECK(f.pages.base() == second);
    CHECK(f.pages.free_count() == 1);
    CHECK_FALSE(f.pages.present(4));
    REQUIRE(f.pages.present(5));
    CHECK(f.pages.free_count() == 2);
}

TEST_CASE("a page that was skipped stays the delta base until a later frame is accepted") {
    Fixture f(4);
    f.accept(1, 10);
    const std::uint32_t skipped = f.accept(2, 5);
    REQUIRE(f.pages.present(10));
    CHECK(f.shown_frame() == 1);
    CHECK(f.pages.base() == skipped);
    CHECK(f.pages.free_count() == 2);
    f.accept(3, 20);
    CHECK(f.pages.free_count() == 2);
}

TEST_CASE("of frames due at the same time the one accepted last is presented") {
    Fixture f(4);
    f.accept(1, 10);
    f.accept(2, 10);
    f.accept(3, 10);
    REQUIRE(f.pages.present(10));
    CHECK(f.shown_frame() == 3);
    CHECK_FALSE(f.pages.present(1000));
}

TEST_CASE("the end of a session keeps what is shown and what was accepted last, and lets go of the rest") {
    Fixture f(4);
    f.accept(1, 0);
    REQUIRE(f.pages.present(0));
    f.accept(2, 1'000'000);
    f.accept(3, 500'000);
    CHECK(f.pages.free_count() == 1);
    f.pages.end_session();
    CHECK(f.pages.base() == Pages::kNone);
    CHECK(f.shown_frame() == 1);
    CHECK(f.pages.free_count() == 2);
    REQUIRE(f.pages.present(0));
    CHECK(f.shown_frame() == 3);
    CHECK_FALSE(f.pages.page(f.pages.shown()).of_session);
    CHECK(f.pages.free_count() == 3);
}
