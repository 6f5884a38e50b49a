#include "transport/address.h"

#include <charconv>

#include <fmt/format.h>

namespace xorvox::transport {
namespace {

Expected<Address> parse_tcp(std::string_view text, std::string_view rest) {
    Address address;
    address.kind = AddressKind::Tcp;
    std::string_view port = rest;
    if (const std::size_t colon = rest.rfind(':'); colon != std::string_view::npos) {
        std::string_view host = rest.substr(0, colon);
        port = rest.substr(colon + 1);
        const bool brackets = host.size() >= 2 && host.front() == '[' && host.back() == ']';
        if (brackets) host = host.substr(1, host.size() - 2);
        if (host.empty()) return fail(fmt::format("{}: the host is empty; write tcp:HOST:PORT or tcp:PORT", text));
        if (!brackets && host.find(':') != std::string_view::npos) {
            return fail(fmt::format("{}: an IPv6 address stands in brackets; write tcp:[{}]:{}", text, host, port));
        }
        address.host = host;
    }
    const char* end = port.data() + port.size();
    const auto [stopped, error] = std::from_chars(port.data(), end, address.port);
    if (error != std::errc{} || stopped != end) {
        return fail(fmt::format("{}: \"{}\" is no port; write a number from 0 to 65535", text, port));
    }
    return address;
}

}  // namespace

Expected<Address> parse_address(std::string_view text) {
    if (text == "loopback") return Address{};
    if (text.starts_with("tcp:")) return parse_tcp(text, text.substr(4));
    if (text.starts_with("file:")) {
        Address address;
        address.kind = AddressKind::File;
        address.path = text.substr(5);
        if (address.path.empty()) return fail("file: the path is empty; write file:PATH");
        return address;
    }
    return fail(fmt::format("\"{}\" is no address; write loopback, tcp:PORT, tcp:HOST:PORT or file:PATH", text));
}

std::string to_string(const Address& address) {
    switch (address.kind) {
        case AddressKind::Loopback: break;
        case AddressKind::File: return "file:" + address.path;
        case AddressKind::Tcp: {
            if (address.host.find(':') == std::string::npos)
                return fmt::format("tcp:{}:{}", address.host, address.port);
            return fmt::format("tcp:[{}]:{}", address.host, address.port);
        }
    }
    return "loopback";
}

}  // namespace xorvox::transport
