// Address: where a display is, as a person writes it on a command line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::transport {

enum class AddressKind : std::uint8_t { Loopback, Tcp, File };

struct Address {
    AddressKind kind = AddressKind::Loopback;
    std::string host = "127.0.0.1";  ///< Tcp only: a name, an IPv4 address, or an IPv6 address without its brackets.
    std::uint16_t port = 0;          ///< Tcp only. 0: any free one, for listening.
    std::string path;                ///< File only.
};

/// Reads `loopback`, `tcp:PORT` (on 127.0.0.1), `tcp:HOST:PORT`, `tcp:[IPV6]:PORT` or `file:PATH`.
/// The message for anything else names what was wrong with it and lists the forms.
Expected<Address> parse_address(std::string_view text);

/// The address as parse_address() reads it.
std::string to_string(const Address& address);

}  // namespace xorvox::transport
