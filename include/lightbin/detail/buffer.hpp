// SPDX-License-Identifier: MIT
// Scratch memory that is kept from call to call and not cleared.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/sizes.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

template <class T> class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    /// Returns memory of `size` elements or more. Their values are lost where it has to grow. Where there is no
    /// memory for them, or `std::size_t` does not count them, it throws as `new` does, and later calls are right.
    T* reserve(std::uint64_t size) {
        if (size > size_) {
            memory_.reset();
            size_ = 0;  // should there be no memory
            memory_ = made(size);
            size_ = static_cast<std::size_t>(size);
        }
        return memory_.get();
    }

    /// The same, keeping the first `used` elements, or as many as there are; grows in large steps.
    T* reserve(std::uint64_t size, std::size_t used) {
        if (size > size_) {
            const std::uint64_t larger = sum_of_sizes(size, size);
            std::unique_ptr<T[]> memory = made(larger);
            std::copy_n(memory_.get(), (std::min)(used, size_), memory.get());
            memory_ = std::move(memory);
            size_ = static_cast<std::size_t>(larger);
        }
        return memory_.get();
    }

    T* data() const { return memory_.get(); }

private:
    /// Uninitialised. More elements than std::size_t counts are as many as it does: no memory has those.
    static std::unique_ptr<T[]> made(std::uint64_t size) {
        constexpr std::uint64_t most = (std::numeric_limits<std::size_t>::max)();
        return std::unique_ptr<T[]>(new T[static_cast<std::size_t>((std::min)(size, most))]);
    }

    std::unique_ptr<T[]> memory_;
    std::size_t size_ = 0;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail

#include <lightbin/detail/warnings_on.inl>
