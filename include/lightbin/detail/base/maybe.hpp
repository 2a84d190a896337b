// SPDX-License-Identifier: MIT
// A value, or none. (std::optional takes some 4 ms to compile for each type of value, which all who include the core pay.)
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <new>
#include <type_traits>
#include <utility>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

template <class T> class Maybe {
public:
    Maybe() {}
    Maybe(T value) { put(std::move(value)); }
    Maybe(const Maybe& other) {
        if (other.there_) put(other.value_);
    }
    Maybe(Maybe&& other) noexcept(std::is_nothrow_move_constructible_v<T>) {
        if (other.there_) put(std::move(other.value_));
    }
    Maybe& operator=(Maybe other) noexcept(std::is_nothrow_move_constructible_v<T>) {
        clear();
        if (other.there_) put(std::move(other.value_));
        return *this;
    }
    ~Maybe() { clear(); }

    explicit operator bool() const { return there_; }
    T& operator*() { return value_; }
    const T& operator*() const { return value_; }
    T* operator->() { return &value_; }
    const T* operator->() const { return &value_; }

private:
    template <class From> void put(From&& from) {
        ::new (static_cast<void*>(&value_)) T(std::forward<From>(from));
        there_ = true;
    }
    void clear() {
        if (there_) value_.~T();
        there_ = false;
    }

    union {
        T value_;
    };
    bool there_ = false;
};

}}}  // namespace lightbin::detail
