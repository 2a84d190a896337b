// SPDX-License-Identifier: MIT
// What the C side's functions do to their arguments and results: structs with a size, enums, null pointers.
#pragma once

#include <lightbin/lightbin.h>

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/checked_sizes.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/isa.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/result.hpp>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

namespace lightbin {
namespace c {

inline lightbin_result succeeded() {
    return {LIGHTBIN_OK, 0, "", 0, 0};
}
inline lightbin_result refused(lightbin_error error, const char* name, std::uint64_t needed = 0,
                               std::uint64_t available = 0) {
    return {error, 0, name, needed, available};
}

/// The C side's number of each ErrorCode, in the order of their declaration. Numbers never change: a new ErrorCode gets
/// the next free number, wherever it is declared.
inline constexpr lightbin_error error_numbers[] = {
    LIGHTBIN_MATRIX_NOT_FINITE,
    LIGHTBIN_NOT_A_PROJECTION,
    LIGHTBIN_PROJECTION_TRANSPOSED,
    LIGHTBIN_EYE_NOT_AT_ORIGIN,
    LIGHTBIN_IMAGE_AXES_ROTATED,
    LIGHTBIN_OBLIQUE_DEPTH,
    LIGHTBIN_NO_NEAR_PLANE,
    LIGHTBIN_NEAR_PLANE_TOO_CLOSE,
    LIGHTBIN_DEPTH_RANGE_NOT_FINITE,
    LIGHTBIN_DEGENERATE_SCALE,
    LIGHTBIN_IMAGE_OFFSET_OUT_OF_RANGE,
    LIGHTBIN_VIEWPORT_OUT_OF_RANGE,
    LIGHTBIN_TILE_SIZE_OUT_OF_RANGE,
    LIGHTBIN_VIEW_MATRIX_NOT_AFFINE,
    LIGHTBIN_VIEW_MATRIX_TRANSPOSED,
    LIGHTBIN_TOO_MANY_LIGHTS,
    LIGHTBIN_TOO_MANY_ENTRIES,
    LIGHTBIN_TOO_MANY_LIST_PLACES,
    LIGHTBIN_RANGE_BUFFER_TOO_SMALL,
    LIGHTBIN_ID_BUFFER_TOO_SMALL,
    LIGHTBIN_GRIDS_DIFFER,
    LIGHTBIN_IDS_ARE_RANKS,
    LIGHTBIN_Z_BOUNDS_TOO_SMALL,
    LIGHTBIN_DEPTH_BUFFER_TOO_SMALL,
    LIGHTBIN_SAMPLES_OUT_OF_RANGE,
    LIGHTBIN_ROW_PITCH_TOO_SMALL,
    LIGHTBIN_NO_SLICES,
    LIGHTBIN_SLICE_RANGE_EMPTY,
    LIGHTBIN_SLICES_DO_NOT_ASCEND,
    LIGHTBIN_TOO_MANY_CELLS,
    LIGHTBIN_TOO_FEW_WEIGHTS,
    LIGHTBIN_LIGHT_BUFFER_TOO_SMALL,
    LIGHTBIN_IDS_TOO_NARROW,
    LIGHTBIN_LIST_BUFFER_TOO_SMALL,
    LIGHTBIN_CAPACITY_UNKNOWN,
    LIGHTBIN_BLOCK_SIZE_UNKNOWN,
    LIGHTBIN_UNIFORM_BLOCK_TOO_SMALL,
    LIGHTBIN_NO_STORAGE_BUFFERS,
    LIGHTBIN_NO_TEXEL_BUFFERS,
    LIGHTBIN_NO_BYTE_ADDRESS_BUFFERS,
    LIGHTBIN_SLOT_OUT_OF_RANGE,
    LIGHTBIN_VIEWS_OUT_OF_RANGE,
    LIGHTBIN_NO_SETS,
    LIGHTBIN_NO_PUSH_CONSTANTS,
    LIGHTBIN_NO_MULTISAMPLE_TEXTURES,
    LIGHTBIN_NO_SUCH_SLICING_SHADER,
    LIGHTBIN_NO_WAVE_OPERATIONS,
    LIGHTBIN_TEXTURE_WIDTH_OUT_OF_RANGE,
    LIGHTBIN_BINDINGS_OVERLAP,
    LIGHTBIN_NOT_A_PREFIX,
    LIGHTBIN_NO_CULL_OF_BOXES,
    LIGHTBIN_TOO_MANY_SLICES,
    LIGHTBIN_VIEW_MATRIX_DISTORTS,
    LIGHTBIN_SCRATCH_TOO_LARGE,
};
static_assert(sizeof error_numbers / sizeof *error_numbers ==
                  sizeof detail::error_sentences / sizeof *detail::error_sentences,
              "lightbin: an ErrorCode has no number in lightbin.h");

inline lightbin_result refused(const Error& error) {
    return refused(error_numbers[static_cast<int>(error.code)], "", error.needed, error.available);
}

/// Returns the sentence of an error that only the C side has.
inline const char* sentence_of(std::int32_t error) {
    switch (error) {
    case LIGHTBIN_OK:
        return "no error";
    case LIGHTBIN_OUT_OF_MEMORY:
        return "there is not enough memory";
    case LIGHTBIN_NULL_ARGUMENT:
        return "this pointer is null and must not be";
    case LIGHTBIN_WRONG_SIZE:
        return "`size` must be sizeof of the struct, {available}, and is {needed}; of a newer lightbin's "
               "struct all that this one does not know must be 0";
    case LIGHTBIN_LEFT_OUT:
        return "lightbin was compiled without this: the define of this name leaves it out";
    case LIGHTBIN_NOT_A_VALUE:
        return "{given} is none of the values that there are for it";
    case LIGHTBIN_STRIDE_TOO_SMALL:
        return "a light's floats are {needed} bytes, and the stride from one light to the next is "
               "{available}";
    case LIGHTBIN_NO_SLICES_GIVEN:
        return "this binner slices depth: give the input `slices`";
    case LIGHTBIN_NO_BOUNDS_GIVEN:
        return "this binner's depth test needs Z bounds: give the input `bounds`";
    case LIGHTBIN_NOT_READ:
        return "the options do not read this input: bounds want a depth test, and slices a slicing; "
               "clusters read no bounds, and lights in view space no matrix";
    case LIGHTBIN_BUFFER_TOO_SMALL:
        return "this memory holds {available} elements, and {needed} are needed";
    case LIGHTBIN_OTHER_MEMORY:
        return "this grid must be in the memory that the next view's lists are to be copied to, at its "
               "beginning";
    case LIGHTBIN_NO_SUCH_ISA:
        return "this machine does not run these vectors, or the library was compiled without them";
    case LIGHTBIN_CALLBACK_THREW:
        return "a callback of the program threw a C++ exception";
    }
    return "unknown error";
}

/// Returns the sentence of a result, with the name and the numbers filled in.
inline Text text_of(const lightbin_result& result) {
    for (std::size_t code = 0; code < sizeof error_numbers / sizeof *error_numbers; ++code)
        if (error_numbers[code] == result.error)
            return Error{static_cast<ErrorCode>(code), result.needed, result.available}.message();
    Text text;
    if (result.name != nullptr && *result.name != 0) {
        text.append(result.name);
        text.append(": ");
    }
    text.append(
        Error{ErrorCode{}, result.needed, result.available}.message(sentence_of(result.error)).c_str());
    return text;
}

/// Copies a text to the caller's memory, cut to its capacity, and returns the length of the whole text.
inline std::size_t write_text(const char* text, std::size_t length, char* to, std::size_t capacity) {
    if (to != nullptr && capacity > 0) {
        const std::size_t kept = detail::min_of(length, capacity - 1);
        std::memcpy(to, text, kept);
        to[kept] = 0;
    }
    return length;
}

/// The greatest `size` that is followed, so that one of chance is not followed through the caller's memory.
inline constexpr std::uint32_t max_size = 1024;

/// The size of a struct in the first version of lightbin.h that had it. A struct that has grown since is named here.
template <class Struct> inline constexpr std::size_t first_size = sizeof(Struct);

/// Returns why the `size` of a caller's struct is refused. The struct may be longer than the library's, if the members
/// that the library does not know are 0.
template <class Struct> lightbin_result check_size(const Struct* given, const char* name) {
    if (given == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    static_assert(sizeof(Struct) <= max_size);
    std::uint32_t size = 0;
    std::memcpy(&size, given, sizeof size);
    bool known = size >= first_size<Struct> && size <= max_size;
    for (std::size_t i = sizeof(Struct); known && i < size; ++i)
        known = reinterpret_cast<const unsigned char*>(given)[i] == 0;
    return known ? succeeded() : refused(LIGHTBIN_WRONG_SIZE, name, size, sizeof(Struct));
}

/// Copies a caller's struct to `known`; members that an older struct lacks become 0.
template <class Struct> lightbin_result read(const Struct* given, Struct& known, const char* name) {
    const lightbin_result result = check_size(given, name);
    if (result.error != LIGHTBIN_OK) return result;
    const std::size_t given_bytes = detail::min_of<std::size_t>(given->size, sizeof known);
    std::memcpy(&known, given, given_bytes);
    std::memset(reinterpret_cast<char*>(&known) + given_bytes, 0, sizeof known - given_bytes);
    return result;
}

/// Copies a struct to the caller's, as far as that has the members. The caller's keeps its `size`, which was checked.
template <class Struct> void write(const Struct& known, Struct* to) {
    const std::uint32_t size = to->size;
    std::memcpy(to, &known, detail::min_of<std::size_t>(size, sizeof known));
    to->size = size;
}

/// Returns why a number is refused that must be 0 to `greatest`.
inline lightbin_result check_value(std::int32_t value, std::int32_t greatest, const char* name) {
    if (0 <= value && value <= greatest) return succeeded();
    return refused(LIGHTBIN_NOT_A_VALUE, name, static_cast<std::uint64_t>(std::int64_t{value}),
                   static_cast<std::uint64_t>(greatest));
}

/// Reads the instruction set that a caller asks for, which this build must have and this machine must run.
inline lightbin_result read_isa(std::int32_t value, Isa& isa, const char* name) {
    const lightbin_result result = check_value(value, LIGHTBIN_AVX512, name);
    if (result.error != LIGHTBIN_OK || value == LIGHTBIN_WIDEST) return result;
    isa = static_cast<Isa>(value - LIGHTBIN_SCALAR);
    return machine_isa(isa) == isa ? result : refused(LIGHTBIN_NO_SUCH_ISA, name);
}

/// Returns the first of several results that is an error, or a success.
template <class... Results> lightbin_result first_error(const Results&... results) {
    lightbin_result first = succeeded();
    static_cast<void>(((first = results, results.error != LIGHTBIN_OK) || ...));
    return first;
}

/// Returns the matrix that the caller's sixteen numbers make, or why they are refused.
inline lightbin_result read_matrix(const lightbin_matrix& given, Matrix& matrix, const char* name) {
    if (given.floats == nullptr && given.doubles == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name);
    const lightbin_result result = check_value(given.layout, LIGHTBIN_ROW_VECTORS, name);
    if (result.error != LIGHTBIN_OK) return result;
    const auto layout = static_cast<MatrixLayout>(given.layout);
    matrix = given.floats != nullptr ? lightbin::matrix(given.floats, layout)
                                     : lightbin::matrix(given.doubles, layout);
    return result;
}

/// Calls body(), which returns a lightbin_result. No exception leaves.
template <class Body> lightbin_result guarded(const Body& body) {
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return refused(LIGHTBIN_OUT_OF_MEMORY, "");
    } catch (const std::length_error&) {  // of std::string and std::vector
        return refused(LIGHTBIN_OUT_OF_MEMORY, "");
    } catch (...) {
        return refused(LIGHTBIN_CALLBACK_THREW, "");
    }
#else
    return body();
#endif
}

/// Makes a handle, whose member `value` is Value(arguments...).
template <class Handle, class... Arguments>
lightbin_result make_handle(Handle** handle, Arguments&&... arguments) {
    return guarded([&] {
        *handle = new Handle{static_cast<Arguments&&>(arguments)...};
        return succeeded();
    });
}

}  // namespace c
}  // namespace lightbin
