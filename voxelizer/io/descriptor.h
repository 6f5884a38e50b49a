// Descriptor: an open file, closed at the end.
#pragma once

#include <utility>

#include <unistd.h>

namespace xorvox::io {

class Descriptor {
public:
    Descriptor() = default;
    /// Owns `number`; one below 0 is none.
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        if (this != &other) {
            close();
            number_ = std::exchange(other.number_, -1);
        }
        return *this;
    }
    ~Descriptor() { close(); }

    int number() const { return number_; }

    /// What ::close() answers; 0 when there is nothing to close.
    int close() noexcept { return number_ < 0 ? 0 : ::close(std::exchange(number_, -1)); }

private:
    int number_ = -1;
};

}  // namespace xorvox::io
