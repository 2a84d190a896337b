// What holds after a call that failed, was left out, or came at the wrong time.
#include "scene.hpp"

#include <lightbin/shader_reduce.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

using namespace lightbin;

static_assert(!std::is_default_constructible_v<View>);  // a View of nothing would list nothing
static_assert(std::is_nothrow_move_constructible_v<Binner<>> && std::is_nothrow_move_assignable_v<Binner<>>);

namespace {

void run_backwards(std::size_t n, const std::function<void(std::size_t)>& body) {
    test::backwards(n, body);
}

}  // namespace

TEST_CASE("a Binner that was moved from is as new, and what it had goes on elsewhere") {
    const View view = test::view({640, 360}, 16);
    const auto lights = test::random_lights(500, 52);
    const auto expected = test::lists(view, lights);
    for (const std::size_t workers : {1u, 3u}) {
        const Parallel parallel(workers, test::backwards);
        Binner<> from;
        const auto grid = from.bin(view, lights, {}, parallel);
        REQUIRE(grid);
        Binner<> to = std::move(from);
        CHECK(test::to_lists(*grid) == expected);  // its memory has gone on with `to`
        CHECK(test::to_lists(*from.bin(view, lights, {}, parallel)) == expected);
        CHECK(test::to_lists(*grid) == expected);
        CHECK(test::to_lists(*to.bin(view, lights, {}, parallel)) == expected);
        Binner<>& same = to;
        to = std::move(same);
        CHECK(test::to_lists(*to.bin(view, lights)) == expected);
        from = std::move(to);
        CHECK(test::to_lists(*to.bin(view, lights, {}, parallel)) == expected);
    }
}

TEST_CASE("a plain function runs a Parallel's work") {
    const View view = test::view({640, 360}, 16);
    const auto lights = test::random_lights(500, 55);
    const auto expected = test::lists(view, lights);
    CHECK(test::lists(view, lights, {}, Parallel(3, run_backwards)) == expected);
    CHECK(test::lists(view, lights, {}, Parallel(3, &run_backwards)) == expected);
    const std::function<void(std::size_t, const std::function<void(std::size_t)>&)> function = run_backwards;
    CHECK(test::lists(view, lights, {}, Parallel(3, function)) == expected);
}

namespace {

/// Checks that to_string() returns a different text for each value of an enum.
template <class Enum> void check_words(Enum first, Enum last) {
    std::set<std::string> words;
    int count = 0;
    for (int value = static_cast<int>(first); value <= static_cast<int>(last); ++value, ++count)
        words.insert(to_string(static_cast<Enum>(value)));
    CHECK(words.size() == static_cast<std::size_t>(count));
    CHECK(!words.contains("?"));
    CHECK(!words.contains("unknown error"));
}

}  // namespace

TEST_CASE("an error's sentence has its numbers, with their sign where what was given may be negative") {
    for (int code = 100; code <= static_cast<int>(ErrorCode::eye_not_finite); ++code) {
        const std::string sentence = to_string(static_cast<ErrorCode>(code)),
                          message = Error{static_cast<ErrorCode>(code), 1234, 5678}.message();
        const auto has = [&](const char* part) { return sentence.find(part) != std::string::npos; };
        CHECK(message.find_first_of("{}") == std::string::npos);
        CHECK((message.find("1234") != std::string::npos) == (has("{needed}") || has("{given}")));
        CHECK((message.find("5678") != std::string::npos) == has("{available}"));
        // Users of C and JavaScript read the same text, so it must not name functions or anything that only C++ has.
        for (const char* const in_one_language : {"::", "()", "(numbers", "Binner", "lightbin_", ".hpp"})
            CHECK_MESSAGE(!has(in_one_language), sentence);
    }
    for (const int given : {-1, -5, std::numeric_limits<int>::min()})
        for (const ErrorCode code :
             {ErrorCode::viewport_out_of_range, ErrorCode::tile_size_out_of_range,
              ErrorCode::samples_out_of_range, ErrorCode::no_slices, ErrorCode::no_sets})
            CHECK(std::string(Error{code, static_cast<std::uint64_t>(given)}.message())
                      .find(" " + std::to_string(given)) != std::string::npos);
    const auto refused = shader_snippet({.language = ShaderLanguage::glsl_430, .tiles = {0, -1}});
    REQUIRE(!refused);
    CHECK(std::string(refused.error().message()).find("18446744073709551615") == std::string::npos);
}

TEST_CASE("every enum has words") {
    check_words(Isa::scalar, Isa::avx512);
    check_words(Slicing::none, Slicing::z_bins);
    check_words(ClipDepth::minus_one_to_one, ClipDepth::zero_to_one);
    check_words(WindowOrigin::lower_left, WindowOrigin::upper_left);
    check_words(DepthFormat::float32, DepthFormat::unorm16);
    check_words(ErrorCode::matrix_not_finite, ErrorCode::eye_not_finite);
    check_words(ListEncoding::offset_count, ListEncoding::sentinel);
    check_words(ShaderLanguage::glsl_430, ShaderLanguage::wgsl);
    check_words(ShaderResource::uniform_vector, ShaderResource::writable_buffer);
    check_words(TexelFormat::none, TexelFormat::r32f);
    check_words(ListStorage::storage_buffer, ListStorage::uniform_block);
    static_assert(std::string_view(to_string(IdWidth::u8)) == "u8" &&
                  std::string_view(to_string(IdWidth::u16)) == "u16" &&
                  std::string_view(to_string(IdWidth::u32)) == "u32");
    CHECK(machine_isa() == test::machine_tiers().back());
    CHECK(machine_isa(Isa::scalar) == Isa::scalar);
}
