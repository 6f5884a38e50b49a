// File: a link that ends in a file of packets, and one that begins in it. Recordings with times and both directions are
// another thing: sim/recording, docs/recordings.md.
//
//   bytes 0 … 7: 'X' 'O' 'R' 'V' 'O' 'X' 01 0A      then one frame (transport/framing.h) a packet
//
// Writing has no way back: LinkInfo::two_way is false, and a session on it takes the display's word for granted.
#pragma once

#include <string>

#include "transport/link.h"
#include "voxelizer/error.h"

namespace xorvox::transport {

/// A link that writes what it is sent to a temporary file of its own (.xorvox-PID-N.tmp) in the folder of `path`. The
/// file gets its name in commit_file(); a link that is closed before leaves nothing behind, so a recording is there
/// whole or not at all. (A process that is killed leaves the temporary file.) An existing file is replaced then, not
/// earlier; of several writers for one path, the last that is committed stays. A symbolic link is followed;
/// directories, devices and pipes are refused. receive() answers Unsupported. A full disk closes the link: send()
/// answers Closed and commit_file() says why. Messages begin with `path`.
Expected<UniqueLink> open_file_writer(const std::string& path);

/// Completes a recording: everything is on the disk and the file has its name. `writer` is what open_file_writer()
/// gave; afterwards send() answers Closed, and closing keeps the file.
Expected<void> commit_file(Link writer);

/// A link whose receive() gives the packets of a recording, in order, then Closed. A damaged place is one Corrupt; so
/// is a packet cut off by the end. What is sent is accepted and forgotten: a device that plays a recording may answer
/// it.
Expected<UniqueLink> open_file_reader(const std::string& path);

}  // namespace xorvox::transport
