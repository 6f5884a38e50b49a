#include "sim/recording/writer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/wire/crc32c.h"
#include "driver/wire/packet.h"
#include "sim/recording/assembler.h"
#include "transport/new_file.h"

namespace xorvox::sim {

struct RecordingWriter::Impl {
    Impl(transport::NewFile new_file, std::size_t frame_bytes) : file(std::move(new_file)), assembler(frame_bytes) {}

    void write(std::span<const std::byte> bytes) {
        file.write(bytes);
        offset += bytes.size();
    }
    void block(BlockKind kind, std::span<const std::byte> payload) {
        write(encode(BlockHeader{kind, static_cast<std::uint32_t>(payload.size()), last_ns}));
        write(payload);
        write(encode_u32(wire::crc32c(payload)));
    }

    transport::NewFile file;
    FrameAssembler assembler;
    std::vector<std::byte> index;
    std::uint64_t offset = 0;
    bool begun = false;
    std::uint64_t first_ns = 0;
    std::uint64_t last_ns = 0;  ///< Since first_ns.
};

RecordingWriter::RecordingWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

Expected<RecordingWriter> RecordingWriter::create(const std::string& path, const DisplayFile& display) {
    if (display.text.empty() || display.text.size() > kMaxDisplayTextBytes) {
        return fail(fmt::format("{}: the display's file has {} bytes; a recording takes 1 to {}", path,
                                display.text.size(), kMaxDisplayTextBytes));
    }
    Expected<transport::NewFile> file = transport::NewFile::create(path);
    if (!file) return tl::unexpected(file.error());
    auto impl = std::make_unique<Impl>(std::move(*file), frame_bytes(display));
    impl->write(encode_head());
    const auto digest = encode_u64(geometry_digest(display));
    std::vector<std::byte> description(digest.begin(), digest.end());
    const auto text = std::as_bytes(std::span(display.text));
    description.insert(description.end(), text.begin(), text.end());
    impl->block(BlockKind::Display, description);
    return RecordingWriter(std::move(impl));
}

void RecordingWriter::packet(BlockKind kind, std::uint64_t time_ns, std::span<const std::byte> bytes) {
    if (bytes.empty() || bytes.size() > wire::kMaxPacketBytes) return;
    Impl& self = *impl_;
    if (!self.begun) self.first_ns = time_ns;
    self.begun = true;
    self.last_ns = std::max(self.last_ns, time_ns - std::min(time_ns, self.first_ns));
    const std::uint64_t place = self.offset;
    self.block(kind, bytes);
    if (kind != BlockKind::FromHost || !self.assembler.take(bytes, place)) return;
    const AssembledFrame& frame = self.assembler.frame();
    const auto entry = encode(FrameEntry{.hello = frame.hello,
                                         .begin = frame.begin,
                                         .time_ns = self.last_ns,
                                         .digest = frame_digest(frame.bytes),
                                         .id = frame.id,
                                         .keyframe = frame.keyframe});
    self.block(BlockKind::Frame, entry);
    self.index.insert(self.index.end(), entry.begin(), entry.end());
    self.file.flush();  // A process that is killed later leaves this frame.
}

std::uint64_t RecordingWriter::frames() const {
    return impl_->index.size() / kFrameEntryBytes;
}

std::uint64_t RecordingWriter::duration_ns() const {
    return impl_->last_ns;
}

Expected<void> RecordingWriter::commit() {
    const std::uint64_t index_at = impl_->offset;
    impl_->block(BlockKind::Index, impl_->index);
    impl_->block(BlockKind::End, encode_u64(index_at));
    return impl_->file.commit();
}

}  // namespace xorvox::sim
