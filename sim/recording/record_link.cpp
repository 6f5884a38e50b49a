#include "sim/recording/record_link.h"

#include <utility>

#include "transport/tap.h"

namespace xorvox::sim {

UniqueLink record_link(UniqueLink inner, LinkEnd end, RecordingWriter& writer, std::function<std::uint64_t()> now_ns) {
    return transport::with_tap(std::move(inner), [end, &writer, now_ns = std::move(now_ns)](
                                                     transport::Passing passing, std::span<const std::byte> packet) {
        const bool from_host = (passing == transport::Passing::Sent) == (end == LinkEnd::Host);
        writer.packet(from_host ? BlockKind::FromHost : BlockKind::FromDevice, now_ns(), packet);
    });
}

}  // namespace xorvox::sim
