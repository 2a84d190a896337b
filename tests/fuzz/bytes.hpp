// SPDX-License-Identifier: MIT
// Reads values from a fuzzer's bytes. Past their end all values are 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    bool empty() const { return left_ == 0; }

    template <class Value> Value take() {
        Value value{};
        const std::size_t n = left_ < sizeof value ? left_ : sizeof value;
        if (n > 0) std::memcpy(&value, data_, n);
        data_ += n;
        left_ -= n;
        return value;
    }
    unsigned byte() { return take<std::uint8_t>(); }
    bool flag() { return (byte() & 1) != 0; }
    /// 0 up to, not including, `end`.
    unsigned below(unsigned end) { return take<std::uint16_t>() % end; }

private:
    const std::uint8_t* data_;
    std::size_t left_;
};
