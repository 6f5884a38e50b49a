#include "tests/contract/transport/backends.h"

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "tests/catch.h"
#include "transport/faults.h"
#include "transport/file.h"
#include "transport/link_template.cpp"
#include "transport/loopback.h"
#include "transport/tap.h"
#include "transport/tcp.h"

namespace xorvox::transport {
namespace {

Ends open_loopback() {
    Ends ends;
    std::tie(ends.near, ends.far) = make_loopback();
    return ends;
}

Ends open_tcp() {
    auto listener = TcpListener::listen(0);
    REQUIRE(listener);
    auto near = connect_tcp("127.0.0.1", listener->port());
    REQUIRE(near);
    Ends ends;
    ends.near = std::move(*near);
    REQUIRE(listener->wait(5'000'000'000) == Status::Ok);
    REQUIRE(listener->accept(ends.far) == Status::Ok);
    return ends;
}

Ends open_file() {
    struct Recording {
        std::string path;
        ~Recording() { std::filesystem::remove(path); }
    };
    static int count = 0;
    const auto recording = std::make_shared<Recording>();
    recording->path =
        (std::filesystem::temp_directory_path() / fmt::format("xorvox-contract-{}-{}", ::getpid(), count++)).string();
    auto writer = open_file_writer(recording->path);
    REQUIRE(writer);
    Ends ends;
    ends.keep = recording;
    ends.near = std::move(*writer);
    ends.live = false;
    ends.deliver = [path = recording->path](Ends& self) {
        REQUIRE(commit_file(self.near.get()));
        auto reader = open_file_reader(path);
        REQUIRE(reader);
        self.far = std::move(*reader);
    };
    return ends;
}

Ends open_template() {
    struct Memory {
        std::array<std::byte, 3000> out_ring{}, in_ring{};
        std::array<std::byte, 1024> near_packet{}, far_packet{};
        ByteQueue out{out_ring}, in{in_ring};
        QueueLink near{out, in, near_packet};
        QueueLink far{in, out, far_packet};
    };
    const auto memory = std::make_shared<Memory>();
    Ends ends;
    ends.keep = memory;
    ends.near = UniqueLink(make_queue_link(memory->near));
    ends.far = UniqueLink(make_queue_link(memory->far));
    return ends;
}

Ends open_faultless() {
    Ends ends = open_loopback();
    ends.near = with_faults(std::move(ends.near), {});
    ends.far = with_faults(std::move(ends.far), {});
    return ends;
}

Ends open_tapped() {
    Ends ends = open_loopback();
    ends.near = with_tap(std::move(ends.near), [](Passing, std::span<const std::byte>) {});
    ends.far = with_tap(std::move(ends.far), [](Passing, std::span<const std::byte>) {});
    return ends;
}

}  // namespace

const std::vector<Backend>& backends() {
    static const std::vector<Backend> all = {
        {"loopback", open_loopback, true},
        {"tcp", open_tcp, true},
        {"file", open_file},
        {"template", open_template},
        {"faults, none of them", open_faultless, true},
        {"tap", open_tapped, true},
    };
    return all;
}

}  // namespace xorvox::transport
