// SPDX-License-Identifier: MIT
// Buffer: memory that the stages keep from call to call.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/checked_sizes.hpp>
#include <lightbin/detail/base/platform.hpp>

#include <utility>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The widest vector of all instruction sets has this many bytes, and this many floats. Kernels load and store whole
/// vectors, so memory that they work on has `widest_vector` elements more than are used: no vector has more elements.
inline constexpr std::size_t widest_vector = 64, widest_lanes = 16;

/// An array whose elements are not initialised, unlike those of std::vector, as they are about to be overwritten.
template <class T> class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    LIGHTBIN_SMALL ~Buffer() { delete[] memory_; }

    /// Returns memory for `size` elements or more. If it has to grow, all values are lost. Throws as `new` does if
    /// there is not enough memory or if `size` exceeds std::size_t; the Buffer remains usable.
    T* reserve(std::uint64_t size) {
        if (size > size_) replace(size);
        return memory_;
    }

    /// Returns memory for `size` elements or more and keeps the values of the first `used` elements. Grows to twice
    /// `size`, so that appending one element at a time takes linear time.
    T* reserve(std::uint64_t size, std::size_t used) {
        if (size > size_) grow(size, used);
        return memory_;
    }

    T* data() const { return memory_; }

    void swap(Buffer& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
    }

private:
    /// Allocates `size` uninitialised elements. A size beyond std::size_t is reduced to its maximum: then `new` throws.
    explicit Buffer(std::uint64_t size)
        : size_(static_cast<std::size_t>(min_of<std::uint64_t>(size, ~std::size_t{0}))) {
#if defined(LIGHTBIN_MEMORY_SANITIZER)
        // Initialised, because kernels read whole words and vectors and ignore parts of them. The sanitizer would
        // report those parts as used.
        memory_ = new T[size_]();
#else
        memory_ = new T[size_];
#endif
    }

    // Not inlined, as the kernels call reserve() in many places and it seldom has to allocate.
    LIGHTBIN_NOINLINE void replace(std::uint64_t size) {
        Buffer().swap(*this);
        Buffer(size).swap(*this);
    }
    LIGHTBIN_NOINLINE void grow(std::uint64_t size, std::size_t used) {
        Buffer larger(sum_of_sizes(size, size));
        for (std::size_t i = 0; i < min_of(used, size_); ++i)
            larger.memory_[i] = std::move(memory_[i]);
        swap(larger);
    }

    T* memory_ = nullptr;
    std::size_t size_ = 0;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
