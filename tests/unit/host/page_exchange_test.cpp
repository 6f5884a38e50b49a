// The page exchange, one atomic step at a time, in every order in which the steps of a writer and its readers can
// follow each other. (That the steps order memory as they must, the threads of framebuffer_test.cpp show under tsan.)
//
// An operation is taken apart without changing it: each time, it runs from its beginning with the values that its steps
// found before, does one step more, and is left by an exception at the next.

#include "driver/host/page_exchange.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <type_traits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "tests/catch.h"

namespace xorvox::host {
namespace {

constexpr std::uint32_t kReaders = 2;
constexpr std::uint32_t kDirty = 0;

/// What the steps of an operation that is under way have found.
struct Steps {
    std::uint32_t count = 0;
    std::array<std::uint32_t, kMaxExchangePages> found{};
};

struct Paused {};

/// The operation that runs now.
struct Run {
    Steps* steps;
    std::uint32_t at = 0;  ///< Steps done, in this run.
    bool stepped = false;

    template <typename Change>
    std::uint32_t step(Change change) {
        if (at == steps->count) {
            if (stepped) throw Paused{};
            steps->found[steps->count++] = change();
            stepped = true;
        }
        return steps->found[at++];
    }
};

struct State;
struct Machine {
    State* state = nullptr;
    Run* run = nullptr;
};
Machine machine;

/// Stands for std::atomic.
struct Word {
    std::uint32_t value = 0;

    std::uint32_t load(std::memory_order) const {
        return machine.run->step([&] { return value; });
    }
    std::uint32_t exchange(std::uint32_t next, std::memory_order) {
        return machine.run->step([&] { return std::exchange(value, next); });
    }
    std::uint32_t fetch_add(std::uint32_t more, std::memory_order);
};

enum class Doing : std::uint32_t { Nothing, Begin, Write, Publish, Take, Release };

struct WriterState {
    PageWriter<Word> side;
    Doing doing = Doing::Begin;
    std::uint32_t page = kNoPage;
    std::uint32_t frames = 0;  ///< Begun.
    Steps steps{};
};

struct ReaderState {
    PageReader<Word> side;
    Doing doing = Doing::Nothing;
    std::uint32_t page = kNoPage;  ///< By its steps: from the one that takes it to the one that lets it go.
    std::uint32_t frame = 0;       ///< That was in it then.
    std::uint32_t last = 0;        ///< That take() answered.
    std::uint32_t due = 0;         ///< Published when take() began.
    std::uint32_t takes = 0;
    Steps steps{};
    std::uint32_t unused = 0;  ///< Fills the struct up.
};

/// Everything; two states with the same bytes go on alike.
struct State {
    PageExchange<Word> exchange{};
    std::array<std::uint32_t, kMaxExchangePages> content{};  ///< Number of the frame, or kDirty.
    std::uint32_t published = 0;                             ///< Number of the latest frame.
    WriterState writer;
    std::array<ReaderState, kReaders> readers;
};
static_assert(std::is_trivially_copyable_v<State>);
static_assert(std::has_unique_object_representations_v<State>);

/// Only readers add.
std::uint32_t Word::fetch_add(std::uint32_t more, std::memory_order) {
    return machine.run->step([&] {
        State& state = *machine.state;
        ReaderState* reader = nullptr;
        for (ReaderState& one : state.readers) {
            if (&one.steps == machine.run->steps) reader = &one;
        }
        const std::uint32_t before = value;
        value += more;
        reader->page = this == &state.exchange.latest ? before & kNoPage : kNoPage;
        if (reader->page != kNoPage) reader->frame = state.content[reader->page];
        return before;
    });
}

/// Does one step of `operation` on `side`. True when it has ended; only then `side` has changed.
template <typename Side, typename Operation>
bool advance(State& state, Side& side, Steps& steps, Operation operation) {
    Run run{&steps};
    machine = {&state, &run};
    Side copy = side;
    try {
        operation(copy);
    } catch (const Paused&) {
        return false;
    }
    side = copy;
    steps = {};
    return true;
}

struct Bounds {
    std::uint32_t pages;
    std::uint32_t readers;
    std::uint32_t frames;
    std::uint32_t takes;
};

class Explorer {
public:
    explicit Explorer(const Bounds& bounds)
        : bounds_(bounds),
          here_{.writer = {PageWriter<Word>(here_.exchange, bounds.pages)},
                .readers = {ReaderState{PageReader<Word>(here_.exchange, bounds.pages)},
                            ReaderState{PageReader<Word>(here_.exchange, bounds.pages)}}} {}
    Explorer(const Explorer&) = delete;
    Explorer& operator=(const Explorer&) = delete;

    void run() {
        arrive();
        while (!waiting_.empty()) {
            const State from = waiting_.back();
            waiting_.pop_back();
            here_ = from;
            if (writer_moves(here_)) arrive();
            for (std::uint32_t reader = 0; reader < bounds_.readers; ++reader) {
                for (const Doing next : {Doing::Take, Doing::Release}) {
                    here_ = from;
                    if (reader_moves(here_, here_.readers[reader], next)) arrive();
                }
            }
        }
    }

    std::size_t states() const { return known_.size(); }
    std::uint32_t no_page = 0;        ///< begin() found none.
    std::uint32_t overwritten = 0;    ///< A reader's page was not whole or changed.
    std::uint32_t mistaken = 0;       ///< take() answered another page than its steps took.
    std::uint32_t old = 0;            ///< take() gave an earlier frame than before, or than there was when it began.
    std::uint32_t overtaken = 0;      ///< take() gave a later frame than there was when it began.
    std::uint32_t whole_runs = 0;     ///< Ends at which all frames were published.
    std::uint32_t replaced_kept = 0;  ///< States in which each reader has a page, all replaced.

private:
    bool writer_moves(State& state) {
        WriterState& writer = state.writer;
        switch (writer.doing) {
            case Doing::Begin:
                if (writer.frames == bounds_.frames) return false;
                if (!advance(state, writer.side, writer.steps, [&](auto& side) { writer.page = side.begin(); }))
                    return true;
                if (writer.page == kNoPage) {
                    ++no_page;
                    return false;
                }
                ++writer.frames;
                state.content[writer.page] = kDirty;
                writer.doing = Doing::Write;
                return true;
            case Doing::Write:
                state.content[writer.page] = writer.frames;
                writer.doing = Doing::Publish;
                return true;
            default:
                if (!advance(state, writer.side, writer.steps, [&](auto& side) { side.publish(writer.page); }))
                    return true;
                writer.page = kNoPage;
                state.published = writer.frames;
                writer.doing = Doing::Begin;
                if (state.published == bounds_.frames) ++whole_runs;
                return true;
        }
    }

    /// One that is between two operations does `next`.
    bool reader_moves(State& state, ReaderState& reader, Doing next) {
        if (reader.doing == Doing::Nothing) {
            if (next == Doing::Take && reader.takes++ == bounds_.takes) return false;
            if (next == Doing::Release && reader.page == kNoPage) return false;
            reader.doing = next;
            reader.due = state.published;
        } else if (reader.doing != next) {
            return false;
        }
        std::uint32_t page = kNoPage;
        const bool ended = advance(state, reader.side, reader.steps, [&](auto& side) {
            if (next == Doing::Take) {
                page = side.take();
            } else {
                side.release();
            }
        });
        if (!ended) return true;
        reader.doing = Doing::Nothing;
        if (next == Doing::Release) return true;
        if (page != reader.page) ++mistaken;
        const std::uint32_t frame = page == kNoPage ? 0 : reader.frame;
        if (frame < reader.last || frame < reader.due) ++old;
        if (frame > reader.due) ++overtaken;
        reader.last = frame;
        return true;
    }

    /// At here_, for the first time or again.
    void arrive() {
        const State& state = here_;
        bool all_replaced = true;
        for (std::uint32_t reader = 0; reader < bounds_.readers; ++reader) {
            const ReaderState& one = state.readers[reader];
            if (one.page == kNoPage) {
                all_replaced = false;
                continue;
            }
            if (one.frame == kDirty || state.content[one.page] != one.frame) ++overwritten;
            if (one.frame == state.published) all_replaced = false;
        }
        if (!known_.emplace(reinterpret_cast<const char*>(&state), sizeof state).second) return;
        if (all_replaced) ++replaced_kept;
        waiting_.push_back(state);
    }

    Bounds bounds_;
    State here_;  ///< Every state is brought to this place, because the sides point to its words.
    std::vector<State> waiting_;
    std::unordered_set<std::string> known_;
};

TEST_CASE(
    "page exchange: in every order of steps frames stay whole, the writer finds a page, and readers get the latest") {
    const Bounds bounds = GENERATE(Bounds{.pages = 3, .readers = 1, .frames = 7, .takes = 6},
                                   Bounds{.pages = 4, .readers = 1, .frames = 6, .takes = 4},
                                   Bounds{.pages = 4, .readers = 2, .frames = 4, .takes = 2});
    Explorer explorer(bounds);
    explorer.run();
    CAPTURE(bounds.pages, bounds.readers, explorer.states());
    CHECK(explorer.no_page == 0);
    CHECK(explorer.overwritten == 0);
    CHECK(explorer.mistaken == 0);
    CHECK(explorer.old == 0);
    // It went everywhere.
    CHECK(explorer.overtaken > 0);
    CHECK(explorer.whole_runs > 0);
    CHECK(explorer.replaced_kept > 0);
}

TEST_CASE("page exchange: with a page too few the writer finds none, instead of one that a reader has") {
    const Bounds bounds = GENERATE(Bounds{.pages = 2, .readers = 1, .frames = 4, .takes = 3},
                                   Bounds{.pages = 3, .readers = 2, .frames = 4, .takes = 2});
    Explorer explorer(bounds);
    explorer.run();
    CHECK(explorer.no_page > 0);
    CHECK(explorer.overwritten == 0);
}

TEST_CASE("page exchange: counts that wrap around leave nothing behind") {
    PageExchange<> exchange;
    PageWriter<> writer(exchange, 3);
    PageReader<> reader(exchange, 3);
    PageReader<> other(exchange, 3);
    writer.publish(writer.begin());
    const std::uint32_t page = other.take();
    // As after 2^28 - 2 takings and releases of the page by others.
    exchange.latest += ((1u << (32 - kPageBits)) - 2u) << kPageBits;
    exchange.released[page] += (1u << (32 - kPageBits)) - 2u;
    for (int i = 0; i < 5; ++i) {
        CHECK(reader.take() == page);
        reader.release();
    }
    const std::uint32_t next = writer.begin();
    writer.publish(next);
    // The other one still has it.
    CHECK(reader.take() == next);
    CHECK(writer.begin() != page);
    other.release();
    CHECK(writer.begin() == page);
}

TEST_CASE("page exchange: no number in the words leads a reader to a page that is not there") {
    for (std::uint32_t word = 0; word < 64; ++word) {
        PageExchange<> exchange;
        PageReader<> reader(exchange, 3);
        exchange.latest = word;
        const std::uint32_t page = reader.take();
        CHECK(page == (word % 16 < 3 ? word % 16 : kNoPage));
    }
}

}  // namespace
}  // namespace xorvox::host
