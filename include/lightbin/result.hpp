// SPDX-License-Identifier: MIT
// Stability: settled.
// Errors that a running program can meet are returned as values with a text; bugs of the program are assertions.
#pragma once

#include <lightbin/detail/base/text.hpp>
#include <lightbin/error_code.hpp>

#include <optional>
#include <utility>

/// Checks a condition that only a bug in the calling program can make false. The default is the standard assert();
/// define LIGHTBIN_ASSERT before including lightbin to replace it.
#ifndef LIGHTBIN_ASSERT
#include <cassert>
#define LIGHTBIN_ASSERT(condition) assert(condition)
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Why a call failed. For errors about sizes, `needed` is the size that the call needed and `available` the size that
/// there was. For errors about other numbers, `needed` is the number given and `available` the greatest one allowed.
struct Error {
    ErrorCode code;
    std::uint64_t needed = 0;
    std::uint64_t available = 0;

    /// Returns to_string(code) with `needed` and `available` in place of its placeholders.
    Text message() const { return message(to_string(code)); }

    /// Returns a sentence with the numbers filled in where it has {needed}, {available} and {given}.
    Text message(const char* sentence) const {
        const bool negative = static_cast<std::int64_t>(needed) < 0;
        Text text;
        for (const char* from = sentence; *from != 0;)
            if (skip(from, "{needed}"))
                text.append(needed);
            else if (skip(from, "{available}"))
                text.append(available);
            else if (!skip(from, "{given}"))
                text.append(*from++);
            else {
                if (negative) text.append('-');
                text.append(negative ? 0 - needed : needed);
            }
        return text;
    }

private:
    /// Moves `text` past `prefix` and returns true if it begins with that; else returns false.
    static bool skip(const char*& text, const char* prefix) {
        const char* at = text;
        for (; *prefix != 0; ++prefix, ++at)
            if (*at != *prefix) return false;
        text = at;
        return true;
    }
};

/// Either a value of type T or the Error that kept the call from making one. Test it before use: reading the value of a
/// failed call, or the error of a successful one, is an assertion failure.
template <class T> class [[nodiscard]] Result {
public:
    Result(T value) : value_(std::move(value)) {}
    Result(Error error) : error_(error) {}

    bool has_value() const { return value_.has_value(); }
    explicit operator bool() const { return has_value(); }

    T& operator*() & { return *checked(value_); }
    const T& operator*() const& { return *checked(value_); }
    /// On a temporary Result, returns the value by value, so that `const T& t = *make();` does not dangle.
    T operator*() && { return std::move(*checked(value_)); }
    T* operator->() { return &*checked(value_); }
    const T* operator->() const { return &*checked(value_); }

    /// Passing a Result where a T is wanted is a compile error with a readable message.
    operator const T&() const {
        static_assert(
            sizeof(T) == 0,
            "lightbin: this is still a Result: if (!result) it has result.error(), else pass *result");
        return **this;
    }

    const Error& error() const {
        LIGHTBIN_ASSERT(!has_value());
        return error_;
    }

private:
    template <class Value> static Value& checked(Value& value) {
        LIGHTBIN_ASSERT(value.has_value());
        return value;
    }

    std::optional<T> value_;
    Error error_ = {};
};

}}  // namespace lightbin
