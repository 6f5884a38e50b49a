// Golden packets: bytes of protocol version 1, made by other means than this code, that must never change.
// driver/PROTOCOL.md shows the same bytes. `#` begins a comment; bytes are two hexadecimal digits.
//
//   messages.hex       NAME bytes …                one packet of each message
//   shared_frames.hex  NAME bytes …                each message of driver/host/shared_frames.h, and a segment's head
//   recording.hex      recording bytes …           a whole recording, sim/recording/format.h
//   conversation.hex   at NS                       the device's clock
//                      boundary                    its display's cycle begins anew
//                      > bytes …   < bytes …       host to device, device to host
#pragma once

#include <cctype>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace xorvox::test {

struct GoldenEntry {
    std::string word;              ///< A name, ">", "<", "boundary" or "at".
    std::uint64_t number = 0;      ///< After "at".
    std::vector<std::byte> bytes;  ///< After a name, ">" or "<".
};

inline std::string read_text(const std::string& path_from_root) {
    std::ifstream file(XORVOX_SOURCE_DIR "/" + path_from_root, std::ios::binary);
    if (!file) throw std::runtime_error("cannot open " + path_from_root);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline std::vector<GoldenEntry> read_golden(const std::string& path_from_root) {
    std::vector<GoldenEntry> entries;
    std::istringstream lines(read_text(path_from_root));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        for (std::string word; words >> word;) {
            const bool hex = word.size() == 2 && std::isxdigit(static_cast<unsigned char>(word[0])) != 0 &&
                             std::isxdigit(static_cast<unsigned char>(word[1])) != 0;
            if (hex) {
                entries.back().bytes.push_back(static_cast<std::byte>(std::stoul(word, nullptr, 16)));
                continue;
            }
            entries.push_back({word, 0, {}});
            if (word == "at") words >> entries.back().number;
        }
    }
    return entries;
}

}  // namespace xorvox::test
