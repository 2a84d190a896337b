// SPDX-License-Identifier: MIT
// Text: what Error::message() and to_string(ViewSummary) return in place of a std::string. Including <string> would
// take the compiler about a fifth of the time that all other headers of the core take.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// A text in memory of its own: making it allocates nothing. It converts to std::string and std::string_view, and can
/// be written to a stream.
class Text {
public:
    const char* c_str() const { return characters_; }  ///< the characters and a 0 after them
    std::size_t size() const { return size_; }         ///< the number of characters

    template <class String>
    requires requires { typename String::traits_type; } operator String() const { return String(characters_, size_); }
    template <class Stream> friend Stream& operator<<(Stream& stream, const Text& text) {
        stream << text.characters_;
        return stream;
    }

    /// Appends a character, a text or a decimal number. What exceeds 511 characters is left out.
    void append(char character) {
        if (size_ + 1 < sizeof characters_) characters_[size_++] = character;
    }
    void append(const char* text) {
        while (*text != 0)
            append(*text++);
    }
    void append(std::uint64_t number) {
        if (number > 9) append(number / 10);
        append(static_cast<char>('0' + number % 10));
    }

private:
    std::size_t size_ = 0;
    char characters_[512] = {};
};

}}  // namespace lightbin
