// Frames through a Framebuffer as fast as they come: one thread writes, others read, and every frame that is read is
// held against its checksum. Ends with status 1 when one was torn or came out of order.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "driver/host/framebuffer.h"
#include "tests/unit/host/checksummed_frame.h"
#include "tools/bench/input.h"
#include "tools/console.h"
#include "voxelizer/error.h"

namespace {

using namespace xorvox;

constexpr std::string_view kUsage =
    "usage: bench_framebuffer [--frames N] [--bytes N] [--readers N]\n"
    "  frames 1 to 4000000000 (100000000), bytes of a frame, a multiple of 8 from 16 (64), "
    "readers 1 to 6 (1)";

struct Options {
    std::uint32_t frames = 100'000'000;
    std::uint32_t bytes = 64;
    std::uint32_t readers = 1;
};

/// What one reader has seen; on a cache line of its own.
struct alignas(64) Seen {
    std::uint32_t frames = 0;
    std::uint32_t torn = 0;
    std::uint32_t out_of_order = 0;
};

/// Reads until frame number `end`.
void read(host::Framebuffer& frames, std::uint32_t reader, std::uint32_t end, Seen& seen) {
    for (std::uint32_t last = 0; last != end;) {
        const host::Frame frame = frames.latest(reader);
        if (frame.sequence == last) continue;
        ++seen.frames;
        seen.out_of_order += frame.sequence < last;
        seen.torn += !test::is_whole(frame);
        last = frame.sequence;
    }
}

/// How long it took to write the frames, in seconds.
double run(const Options& options, std::vector<Seen>& seen) {
    host::Framebuffer frames(options.bytes, options.readers);
    std::atomic<std::uint32_t> ready{0};
    std::vector<std::jthread> readers;
    for (std::uint32_t reader = 0; reader < options.readers; ++reader) {
        readers.emplace_back([&, reader] {
            ++ready;
            read(frames, reader, options.frames, seen[reader]);
        });
    }
    while (ready != options.readers) std::this_thread::yield();
    const auto began = std::chrono::steady_clock::now();
    for (std::uint32_t sequence = 1; sequence <= options.frames; ++sequence) {
        test::write_checksummed(frames.begin_frame(), sequence);
        (void)frames.end_frame(test::tag_of(sequence));  // Begun, so Ok.
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

Expected<Options> parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; i += 2) {
        const std::string option = argv[i];
        std::uint32_t* number = option == "--frames"    ? &options.frames
                                : option == "--bytes"   ? &options.bytes
                                : option == "--readers" ? &options.readers
                                                        : nullptr;
        if (number == nullptr || i + 1 == argc) return fail(fmt::format("'{}' is not understood; {}", option, kUsage));
        const std::uint32_t most = number == &options.readers  ? host::Framebuffer::kMaxReaders
                                   : number == &options.frames ? 4'000'000'000
                                                               : 1u << 28;
        const auto given = tools::parse_numbers(option, argv[i + 1], most);
        if (!given) return tl::unexpected(given.error());
        *number = given->front();
    }
    if (options.bytes < 16 || options.bytes % 8 != 0) {
        return fail(fmt::format("--bytes {}: not a multiple of 8 from 16", options.bytes));
    }
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    const Expected<Options> options = parse(argc, argv);
    if (!options) {
        tools::complain(options.error().message);
        return 2;
    }
    std::vector<Seen> seen(options->readers);
    const double seconds = run(*options, seen);
    fmt::print("{} frames of {} bytes written in {:.2f} s: {:.2f} million frames/s\n",
               tools::thousands(options->frames), options->bytes, seconds, options->frames / seconds / 1e6);
    bool whole = true;
    for (const Seen& one : seen) {
        fmt::print("  a reader checked {}, {:.2f} million/s: {} torn, {} out of order\n", tools::thousands(one.frames),
                   one.frames / seconds / 1e6, one.torn, one.out_of_order);
        whole = whole && one.torn == 0 && one.out_of_order == 0;
    }
    return whole ? 0 : 1;
}
