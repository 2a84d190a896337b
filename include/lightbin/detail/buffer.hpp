// SPDX-License-Identifier: MIT
// Scratch memory that is kept from call to call and not cleared.
#pragma once

#include <lightbin/detail/flavour.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

template <class T> class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    /// Returns room for `size` elements. Their values are lost when the room has to grow.
    T* room(std::size_t size) {
        if (size > size_) {
            memory_.reset();
            memory_.reset(new T[size]);  // uninitialised
            size_ = size;
        }
        return memory_.get();
    }

    /// The same, keeping the first `used` elements; grows in large steps.
    T* room(std::size_t size, std::size_t used) {
        if (size > size_) {
            const std::size_t larger = 2 * size;
            std::unique_ptr<T[]> memory(new T[larger]);
            std::copy_n(memory_.get(), used, memory.get());
            memory_ = std::move(memory);
            size_ = larger;
        }
        return memory_.get();
    }

    T* data() const { return memory_.get(); }

private:
    std::unique_ptr<T[]> memory_;
    std::size_t size_ = 0;
};

}  // namespace lightbin::detail
