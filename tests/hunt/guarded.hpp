// SPDX-License-Identifier: MIT
// Memory of the caller's with a pattern before and after it, to see that nothing is written there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>

namespace hunt {

/// `size` elements. The memory ends with the guard, so that an address sanitizer sees what is read beyond, too, but
/// for the guard's few bytes.
template <class T> class Guarded {
    static constexpr std::size_t guard = (64 + sizeof(T) - 1) / sizeof(T);

public:
    explicit Guarded(std::size_t size) : memory_(new T[size + 2 * guard]), size_(size) {
        std::memset(static_cast<void*>(memory_.get()), 0xa5, (size + 2 * guard) * sizeof(T));
    }
    std::span<T> span() { return {memory_.get() + guard, size_}; }
    std::span<T> span(std::size_t size) { return span().first(size); }

    /// Whether nothing from element `used` on was written, nor before the first.
    bool intact(std::size_t used) const {
        const auto* bytes = reinterpret_cast<const unsigned char*>(memory_.get());
        const auto written = [](unsigned char byte) { return byte != 0xa5; };
        return std::none_of(bytes, bytes + guard * sizeof(T), written) &&
               std::none_of(bytes + (guard + used) * sizeof(T), bytes + (size_ + 2 * guard) * sizeof(T),
                            written);
    }

private:
    std::unique_ptr<T[]> memory_;
    std::size_t size_;
};

}  // namespace hunt
