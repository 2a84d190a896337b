// SPDX-License-Identifier: MIT
// Scratch memory that is kept from call to call and not cleared.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/checked_sizes.hpp>
#include <lightbin/detail/base/platform.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

template <class T> class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer() { delete[] memory_; }

    /// Returns memory of `size` elements or more. Their values are lost where it has to grow. Where there is no
    /// memory for them, or `std::size_t` does not count them, it throws as `new` does, and later calls are right.
    T* reserve(std::uint64_t size) {
        if (size > size_) {
            Buffer().swap(*this);
            Buffer(size).swap(*this);
        }
        return memory_;
    }

    /// The same, keeping the first `used` elements, or as many as there are; grows in large steps.
    T* reserve(std::uint64_t size, std::size_t used) {
        if (size > size_) {
            Buffer larger(sum_of_sizes(size, size));
            used = min_of(used, size_);
            if constexpr (std::is_trivially_copyable_v<T>)
                copy_items(memory_, used, larger.memory_);
            else
                for (std::size_t i = 0; i < used; ++i)
                    larger.memory_[i] = std::move(memory_[i]);
            swap(larger);
        }
        return memory_;
    }

    T* data() const { return memory_; }

    void swap(Buffer& other) noexcept {
        T* const memory = other.memory_;
        const std::size_t size = other.size_;
        other.memory_ = memory_;
        other.size_ = size_;
        memory_ = memory;
        size_ = size;
    }

private:
    /// Uninitialised. More elements than std::size_t counts are as many as it does: no memory has those.
    explicit Buffer(std::uint64_t size)
        : size_(static_cast<std::size_t>(min_of<std::uint64_t>(size, ~std::size_t{0}))) {
#if defined(LIGHTBIN_MEMORY_SANITIZER)
        // Kernels read whole words and vectors; it takes what they leave unused of them for used.
        memory_ = new T[size_]();
#else
        memory_ = new T[size_];
#endif
    }

    T* memory_ = nullptr;
    std::size_t size_ = 0;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
