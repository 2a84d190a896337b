// SPDX-License-Identifier: MIT
// What the C side's functions do to their arguments and results: structs with a size, enums, null pointers.
#pragma once

#include <lightbin/lightbin.h>

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/checked_sizes.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/result.hpp>

#include <atomic>
#include <cstring>
#include <new>

namespace lightbin {
namespace c {

inline lightbin_result succeeded() {
    return {LIGHTBIN_OK, 0, "", 0, 0};
}
inline lightbin_result refused(lightbin_error error, const char* name, std::uint64_t needed = 0,
                               std::uint64_t available = 0) {
    return {error, 0, name, needed, available};
}

inline lightbin_result refused(const Error& error) {
    return refused(static_cast<lightbin_error>(error.code), "", error.needed, error.available);
}

/// The sentences of the errors that only the C side has, in the order of their numbers.
inline constexpr const char* sentences[] = {
    "no error",
    "there is not enough memory",
    "this pointer is null and must not be",
    ("`size` must be sizeof of the struct, {available}, and is {needed}; of a newer lightbin's struct all that this one "
     "does not know must be 0"),
    "lightbin was compiled without this: the define of this name leaves it out",
    "{given} is none of the values that there are for it",
    "a light's floats are {needed} bytes, and the stride from one light to the next is {available}",
    "this binner slices depth: give the input `slices`",
    "this binner's depth test needs Z bounds: give the input `bounds`",
    ("the options do not read this input: bounds want a depth test or clusters, slices a slicing, and lights "
     "in view space no matrix"),
    "this memory holds {available} elements, and {needed} are needed",
};
static_assert(sizeof sentences / sizeof *sentences == LIGHTBIN_BUFFER_TOO_SMALL + 1);

/// Returns an English sentence for a result, with its name and numbers filled in.
inline Text text_of(const lightbin_result& result) {
    if (result.error >= LIGHTBIN_MATRIX_NOT_FINITE && result.error <= LIGHTBIN_EYE_NOT_FINITE)
        return Error{static_cast<ErrorCode>(result.error), result.needed, result.available}.message();
    Text text;
    if (result.name != nullptr && *result.name != 0) {
        text.append(result.name);
        text.append(": ");
    }
    const bool known = 0 <= result.error && result.error <= LIGHTBIN_BUFFER_TOO_SMALL;
    text.append(Error{ErrorCode{}, result.needed, result.available}
                    .message(known ? sentences[result.error] : "unknown error")
                    .c_str());
    return text;
}

/// Copies a text to the caller's memory, cut to its capacity, and returns the length of the whole text.
inline std::size_t write_text(const Text& text, char* to, std::size_t capacity) {
    if (to != nullptr && capacity > 0) {
        const std::size_t kept = detail::min_of(text.size(), capacity - 1);
        std::memcpy(to, text.c_str(), kept);
        to[kept] = 0;
    }
    return text.size();
}

/// The greatest `size` of a caller's struct, which may be any number if the caller did not set it: memory further
/// behind the struct is not read.
inline constexpr std::uint32_t max_size = 1024;

/// Returns why the `size` of a caller's struct is refused. The struct may be longer than the library's, if the members
/// that the library does not know are 0.
template <class Struct> lightbin_result check_size(const Struct* given, const char* name) {
    if (given == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    static_assert(sizeof(Struct) <= max_size);
    std::uint32_t size = 0;
    std::memcpy(&size, given, sizeof size);
    bool known = size >= sizeof(Struct) && size <= max_size;
    for (std::size_t i = sizeof(Struct); known && i < size; ++i)
        known = reinterpret_cast<const unsigned char*>(given)[i] == 0;
    return known ? succeeded() : refused(LIGHTBIN_WRONG_SIZE, name, size, sizeof(Struct));
}

/// Copies the members of a caller's struct that the library knows, or returns why its `size` is refused.
template <class Struct> lightbin_result read(const Struct* given, Struct& known, const char* name) {
    const lightbin_result result = check_size(given, name);
    if (result.error == LIGHTBIN_OK) known = *given;
    return result;
}

/// Copies a struct to the caller's, which keeps its `size`.
template <class Struct> lightbin_result write(std::type_identity_t<Struct> known, Struct* to) {
    known.size = to->size;
    *to = known;
    return succeeded();
}

/// Returns the error that a number is none of its enum's values.
inline lightbin_result not_a_value(std::int32_t given, const char* name) {
    return refused(LIGHTBIN_NOT_A_VALUE, name, static_cast<std::uint64_t>(std::int64_t{given}));
}

// read_member() reads a member of a caller's struct: 0 leaves the default. Enums have the same numbers on both sides,
// and to_string() has a name for each.
inline lightbin_result read_member(std::int32_t given, bool& known, const char*) {
    known = given != 0;
    return succeeded();
}
template <class Number>
requires std::is_integral_v<Number> lightbin_result read_member(Number given, Number& known, const char*) {
    if (given != 0) known = given;
    return succeeded();
}
template <class Enum>
requires std::is_enum_v<Enum> lightbin_result read_member(std::int32_t given, Enum& known, const char* name) {
    if (given != 0) known = static_cast<Enum>(given);
    return 0 <= given && given < 256 && *to_string(known) != '?' ? succeeded() : not_a_value(given, name);
}
inline lightbin_result read_member(const lightbin_matrix& given, Matrix& known, const char* name) {
    if (given.floats == nullptr && given.doubles == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    if (given.layout < 0 || given.layout > LIGHTBIN_ROW_VECTORS) return not_a_value(given.layout, name);
    const auto layout = static_cast<MatrixLayout>(given.layout);
    known = given.floats != nullptr ? matrix(given.floats, layout) : matrix(given.doubles, layout);
    return succeeded();
}
/// Copies the member `name` of the C struct `given` to the C++ struct `known`. Returns why its value is refused, or a
/// success.
#define LIGHTBIN_MEMBER(name) read_member(given.name, known.name, "options." #name)

/// Returns the first of several results that is an error, or a success.
template <class... Results> lightbin_result first_error(const Results&... results) {
    lightbin_result first = succeeded();
    static_cast<void>(((first = results, results.error != LIGHTBIN_OK) || ...));
    return first;
}

/// An argument that must not be a null pointer, and its name for the error.
struct Needed {
    const void* pointer;
    const char* name;
};
inline lightbin_result check_pointers(std::initializer_list<Needed> pointers) {
    for (const Needed& each : pointers)
        if (each.pointer == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, each.name);
    return succeeded();
}

/// Returns why an array is refused, which may be null only if it has no elements.
inline lightbin_result check_array(const void* array, std::uint64_t count, const char* name) {
    return array == nullptr && count > 0 ? refused(LIGHTBIN_NULL_ARGUMENT, name) : succeeded();
}

/// Returns `checked` if that is an error, else what body() returns, a lightbin_result. No exception leaves.
template <class Body> lightbin_result call_if(const lightbin_result& checked, const Body& body) {
    if (checked.error != LIGHTBIN_OK) return checked;
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
    try {
        return body();
    } catch (...) {  // std::bad_alloc, or the std::length_error of std::string and std::vector
        return refused(LIGHTBIN_OUT_OF_MEMORY, "");
    }
#else
    return body();
#endif
}

/// Makes a handle, whose members are made of `arguments`.
template <class Handle, class... Arguments>
lightbin_result make_handle(Handle** handle, Arguments&&... arguments) {
    *handle = new Handle{static_cast<Arguments&&>(arguments)...};
    return succeeded();
}

/// Returns the address of C structs as the address of the C++ structs that have the same members, or the reverse. The
/// compiler must not reorder accesses by the two types, which it takes for different objects: the fence, which makes no
/// instruction, lies between those that precede the call and those that follow it.
template <class To, class From> auto* same_layout(From* from) {
    static_assert(sizeof(To) == sizeof(From) && alignof(To) == alignof(From));
    std::atomic_signal_fence(std::memory_order_seq_cst);
    return reinterpret_cast<std::conditional_t<std::is_const_v<From>, const To, To>*>(from);
}

/// Copies a struct of numbers to the caller's memory, an array or a struct of the same numbers.
template <class Numbers> lightbin_result write_numbers(const Numbers& made, void* to) {
    std::memcpy(to, &made, sizeof made);
    return succeeded();
}

/// Copies `needed` items to the caller's memory.
template <class From, class To>
lightbin_result write_items(const From* from, std::size_t needed, To* to, std::size_t capacity, const char* name) {
    static_assert(sizeof(From) == sizeof(To));
    if (to == nullptr && needed > 0 && capacity > 0) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    if (capacity < needed) return refused(LIGHTBIN_BUFFER_TOO_SMALL, name, needed, capacity);
    if (needed > 0) std::memcpy(to, from, needed * sizeof *from);
    return succeeded();
}

}  // namespace c
}  // namespace lightbin
