#include "driver/host/frame_client.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/socket.h>

namespace xorvox::host {
namespace {

/// Sends all of it at once, with a descriptor if there is one. A peer that leaves no room is as one that is gone.
template <class Message>
bool send_message(int socket, Message& message, int passed) {
    union {
        cmsghdr align;
        unsigned char bytes[CMSG_SPACE(sizeof(int))];
    } control{};
    iovec part{&message, sizeof message};
    msghdr whole{};
    whole.msg_iov = &part;
    whole.msg_iovlen = 1;
    if (passed >= 0) {
        whole.msg_control = control.bytes;
        whole.msg_controllen = sizeof control.bytes;
        cmsghdr* const rights = CMSG_FIRSTHDR(&whole);
        rights->cmsg_level = SOL_SOCKET;
        rights->cmsg_type = SCM_RIGHTS;
        rights->cmsg_len = CMSG_LEN(sizeof(int));
        std::memcpy(CMSG_DATA(rights), &passed, sizeof passed);
    }
    for (;;) {
        const ssize_t sent = ::sendmsg(socket, &whole, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent >= 0) return static_cast<std::size_t>(sent) == sizeof message;
        if (errno != EINTR) return false;
    }
}

/// Whether a client that made this mistake is heard further.
bool goes_on(xorvox_frames_status status) {
    return status != XORVOX_FRAMES_WRONG_MESSAGE && status != XORVOX_FRAMES_WRONG_VERSION;
}

}  // namespace

FrameTerms::FrameTerms(const DisplayDescription& display)
    : frame_bytes(xorvox::frame_bytes(display)),
      geometry_digest(xorvox::geometry_digest(display)),
      pixel_format(static_cast<std::uint32_t>(display.format)) {}

xorvox_frames_status check_request(std::span<const std::byte> message, const FrameTerms& terms,
                                   xorvox_frames_request& request) {
    xorvox_frames_request read{};
    if (message.size() != sizeof read) return XORVOX_FRAMES_WRONG_MESSAGE;
    std::memcpy(&read, message.data(), sizeof read);
    if (std::memcmp(read.magic, XORVOX_FRAMES_MAGIC, sizeof read.magic) != 0) return XORVOX_FRAMES_WRONG_MESSAGE;
    if (read.version != XORVOX_FRAMES_VERSION) return XORVOX_FRAMES_WRONG_VERSION;
    if (read.what != XORVOX_FRAMES_PUBLISH) return XORVOX_FRAMES_WRONG_MESSAGE;
    request = read;
    if (read.page >= FrameSegment::kPages) return XORVOX_FRAMES_WRONG_PAGE;
    if (read.pixel_format != terms.pixel_format) return XORVOX_FRAMES_WRONG_FORMAT;
    if (read.frame_bytes != terms.frame_bytes) return XORVOX_FRAMES_WRONG_SIZE;
    if (read.geometry_digest != terms.geometry_digest) return XORVOX_FRAMES_WRONG_GEOMETRY;
    return XORVOX_FRAMES_OK;
}

bool send_hello(int socket, const FrameTerms& terms, xorvox_frames_status status, const FrameSegment* segment) {
    xorvox_frames_hello hello{};
    std::memcpy(hello.magic, XORVOX_FRAMES_MAGIC, sizeof hello.magic);
    hello.version = XORVOX_FRAMES_VERSION;
    hello.status = static_cast<std::uint32_t>(status);
    hello.segment_bytes = segment != nullptr ? segment->bytes() : 0;
    hello.frame_bytes = terms.frame_bytes;
    hello.geometry_digest = terms.geometry_digest;
    hello.pages = segment != nullptr ? FrameSegment::kPages : 0;
    hello.pixel_format = terms.pixel_format;
    return send_message(socket, hello, segment != nullptr ? segment->descriptor() : -1);
}

FrameClient::FrameClient(Descriptor socket, FrameSegment segment, const FrameTerms& terms, Framebuffer& frames,
                         ShareStatistics& statistics)
    : socket_(std::move(socket)),
      segment_(std::move(segment)),
      terms_(terms),
      frames_(frames),
      statistics_(statistics),
      reader_(segment_.exchange(), FrameSegment::kPages) {}

bool FrameClient::poll() {
    bool heard = true;
    for (int i = 0; heard && (gone_ || i < kMessagesAtOnce); ++i) {
        // Room for one byte more tells a message that is too long. Descriptors that come with it are dropped unseen.
        std::array<std::byte, sizeof(xorvox_frames_request) + 1> message;
        const ssize_t size = ::recv(socket_.get(), message.data(), message.size(), MSG_DONTWAIT);
        if (size < 0 && errno == EINTR) continue;
        if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
        // Of a client that left replies unread this comes first, then its requests.
        if (size < 0 && errno == ECONNRESET && !gone_) {
            gone_ = true;
            continue;
        }
        heard = size > 0 && answer(std::span(message).first(static_cast<std::size_t>(size)));
    }
    // Also of a client that is gone: what it published last is whole.
    take_latest();
    return heard && !gone_;
}

bool FrameClient::answer(std::span<const std::byte> message) {
    xorvox_frames_request request{};
    request.page = XORVOX_FRAMES_NO_PAGE;
    const xorvox_frames_status status = check_request(message, terms_, request);
    if (status == XORVOX_FRAMES_OK) {
        take(request.page, request.tag);
        ++statistics_.by_message;
    } else {
        ++statistics_.refused[static_cast<std::size_t>(status)];
    }
    xorvox_frames_reply reply{};
    std::memcpy(reply.magic, XORVOX_FRAMES_MAGIC, sizeof reply.magic);
    reply.version = XORVOX_FRAMES_VERSION;
    reply.status = static_cast<std::uint32_t>(status);
    reply.page = request.page;
    reply.sequence = status == XORVOX_FRAMES_OK ? static_cast<std::uint32_t>(statistics_.frames()) : 0;
    if (!gone_ && !send_message(socket_.get(), reply, -1)) {
        gone_ = true;
        ::shutdown(socket_.get(), SHUT_RDWR);  // So that the requests which are there are the last ones.
    }
    return goes_on(status);
}

void FrameClient::take_latest() {
    // A page that the reader has is not published again: the same number is the same frame.
    const std::uint32_t page = reader_.take();
    if (page == seen_) return;
    seen_ = page;
    if (page == kNoPage) return;
    take(page, segment_.tag(page));
    ++statistics_.by_exchange;
}

void FrameClient::take(std::uint32_t page, std::uint64_t tag) {
    const std::span<const std::byte> from = segment_.page(page);
    std::memcpy(frames_.begin_frame().data(), from.data(), from.size());
    (void)frames_.end_frame(tag);  // Begun, so Ok.
}

}  // namespace xorvox::host
