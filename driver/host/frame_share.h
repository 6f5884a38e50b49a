// FrameShare: lets other programs draw the frames of a display. It listens at a Unix socket, gives each program that
// connects a segment of memory to draw into, and copies what is published there into a Framebuffer. The protocol and
// its rules: driver/host/shared_frames.h, which is all that the other programs need. Linux.
//
//     Framebuffer frames(frame_bytes(display));
//     auto share = FrameShare::listen(display, "/tmp/display", frames);
//
//     // a thread of its own                       // the one that shows
//     while (!done) {                              const Frame frame = frames.latest();
//         (*share)->poll(now_ns);
//         (*share)->wait(-1);
//     }
//
// One program draws at a time. Whatever it does, and however it ends, the Framebuffer keeps the last whole frame, and
// the next program gets a segment of its own, which no earlier one can reach.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <sys/types.h>

#include "driver/display/description.h"
#include "driver/host/descriptor.h"
#include "driver/host/frame_client.h"
#include "driver/host/framebuffer.h"
#include "voxelizer/error.h"

namespace xorvox::host {

/// poll(), wait() and statistics(): one thread at a time. wake(): any thread. Only poll() allocates, and that only when
/// a program connects.
class FrameShare {
public:
    /// Creates the socket at `path`, for programs of this user alone (mode 0600), in a folder that is there. A socket
    /// left there by a program that is gone is replaced. `display` must be valid, and what it borrows must outlive the
    /// server; so must `frames`, of frame_bytes(display), whose only writer the server is. An Error: the path is empty,
    /// too long, in use or something else than a socket; or what the system says.
    static Expected<std::unique_ptr<FrameShare>> listen(const DisplayDescription& display, const std::string& path,
                                                        Framebuffer& frames);
    FrameShare(const FrameShare&) = delete;
    FrameShare& operator=(const FrameShare&) = delete;
    /// Removes the socket, if it is still this server's.
    ~FrameShare();

    /// Takes the frames that have been published, replies, lets programs in and turns others away. Never waits, and
    /// does a bounded amount of work. `now_ns` never goes back; it measures how long a program has published nothing.
    void poll(std::uint64_t now_ns);

    /// Waits until there is something for poll(), for `timeout_ns` at most; for ever if that is negative. While a
    /// program is connected no longer than a cycle of the display, or 50 ms: nothing tells of frames that are published
    /// by atomics. A signal ends it, too.
    void wait(std::int64_t timeout_ns);

    /// Ends the wait() that is running, or else the next one.
    void wake();

    const ShareStatistics& statistics() const { return statistics_; }

private:
    FrameShare(const DisplayDescription& display, Framebuffer& frames, std::string path, Descriptor listener,
               Descriptor wake);
    void let_in(Descriptor socket, std::uint64_t now_ns);

    DisplayDescription display_;
    FrameTerms terms_;
    Framebuffer& frames_;
    std::string path_;
    dev_t device_ = 0;  ///< With inode_: which file at path_ is ours.
    ino_t inode_ = 0;
    Descriptor listener_;
    Descriptor wake_;
    ShareStatistics statistics_;
    std::optional<FrameClient> client_;
    std::uint64_t published_ns_ = 0;  ///< When the client last did, or came.
    bool accepts_ = true;             ///< False: the system has no descriptor for another client at the moment.
};

}  // namespace xorvox::host
