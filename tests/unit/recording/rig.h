// Recordings for tests: frames as a host sends them, in files of a folder that goes at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/toml.h"
#include "sim/recording/reader.h"
#include "sim/recording/writer.h"

namespace xorvox::test {

using Frame = std::vector<std::byte>;

/// A folder of the test's own.
class Folder {
public:
    Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(path_); }
    std::string file(std::string_view name) const { return (path_ / name).string(); }
    std::vector<std::string> names() const;

private:
    std::filesystem::path path_;
};

/// Two planes of 3 × 2 pixels, rgb332: 12 bytes a frame.
DisplayFile tiny_display();

/// How frames are sent: what a recording's meaning does not depend on.
struct Sending {
    std::uint32_t max_packet_bytes = 65536;
    bool lz4 = false;
    bool deltas = false;  ///< Each onto the one before, where that is shorter.
    std::uint16_t session = 0x1234;
    std::uint64_t every_ns = 20'000'000;
    std::uint64_t present_after_ns = 0;  ///< 0: at the next boundary.
};

/// A host that says hello and sends `frames`, into `writer`.
void send_frames(sim::RecordingWriter& writer, const std::vector<Frame>& frames, const Sending& sending = {});
/// The same into a new file.
void record_frames(const std::string& path, const DisplayFile& display, const std::vector<Frame>& frames,
                   const Sending& sending = {});

/// Frames without any symmetry, all different.
std::vector<Frame> some_frames(const DisplayDescription& display, std::size_t count);

std::vector<std::byte> read_bytes(const std::string& path);
sim::ByteSource bytes_source(std::vector<std::byte> bytes);

/// The frames that are whole, and what was said of the rest.
struct Read {
    std::vector<Frame> frames;
    std::vector<std::string> damage;
};
Read read_frames(sim::RecordingReader& reader, const DisplayDescription& display);

/// One of tests/golden/recordings, which must be whole.
sim::RecordingReader open_golden(const std::string& name);

}  // namespace xorvox::test
