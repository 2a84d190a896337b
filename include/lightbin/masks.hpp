// SPDX-License-Identifier: MIT
// Stability: settled.
// MaskBinner: masks of the columns and rows of tiles, which say what the lists of all tiles say: for 1,000 lights at
// 1920x1080 in 17 KB.
#pragma once

#include <lightbin/detail/engine/make_masks.hpp>
#include <lightbin/detail/stages/ranked_footprints.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Tells which lights are in which tiles by a bit mask for each column of tiles and one for each row, in which bit b of
/// word w stands for the light ids()[32 w + b]. Each light covers a rectangle of tiles, so it is in tile (x, y) exactly
/// if it is in column x and in row y: the bits of  column(x)[w] & row(y)[w],  over all w, are the lights of the tile.
///
/// A LightMasks points to memory of the MaskBinner that made it, see MaskBinner::bin().
class LightMasks {
public:
    LightMasks(int tiles_x, int tiles_y, std::span<const std::uint32_t> words, const LightCounts& counts,
               std::span<const BinRange> bins)
        : words_(words), bins_(bins), counts_(counts), tiles_x_(tiles_x), tiles_y_(tiles_y) {}

    int tiles_x() const { return tiles_x_; }
    int tiles_y() const { return tiles_y_; }

    /// The number of words of 32 bits in each mask, W: enough for all lights in view, and 0 if there are none.
    std::uint32_t mask_words() const { return words_[0]; }

    /// Everything that a shader reads, to be uploaded as it is: W; the masks of all columns, W words each, and an empty
    /// mask; the masks of all rows; 32 W ids, which are 0 beyond the lights in view; and the members of bins(). In all
    /// 1 + (tiles_x() + 1 + tiles_y() + 32) W + 2 bins().size() words.
    std::span<const std::uint32_t> words() const { return words_; }

    /// Returns the mask of column x of tiles, where 0 <= x < tiles_x().
    std::span<const std::uint32_t> column(int x) const {
        LIGHTBIN_ASSERT(x >= 0 && x < tiles_x_);
        return words_.subspan(mask_at(x), mask_words());
    }
    /// Returns the mask of row y of tiles, where 0 <= y < tiles_y().
    std::span<const std::uint32_t> row(int y) const {
        LIGHTBIN_ASSERT(y >= 0 && y < tiles_y_);
        return words_.subspan(mask_at(tiles_x_ + 1 + y), mask_words());
    }

    /// The positions in the caller's array of the lights in view, in ascending order, or with z-bins in order of depth.
    std::span<const std::uint32_t> ids() const {
        return words_.subspan(mask_at(tiles_x_ + 1 + tiles_y_), counts_.lights - counts_.rejected - counts_.culled);
    }

    /// With z-bins, for each the range in ids() of the lights that meet it; else empty.
    std::span<const BinRange> bins() const { return bins_; }

    const LightCounts& light_counts() const { return counts_; }

private:
    std::size_t mask_at(int i) const { return 1 + static_cast<std::size_t>(i) * mask_words(); }

    std::span<const std::uint32_t> words_;
    std::span<const BinRange> bins_;
    LightCounts counts_;
    int tiles_x_, tiles_y_;
};

/// Makes masks of the columns and rows of tiles. Every tile has the same lights as in the lists of a Binner with the
/// default Options, in memory whose size depends on the numbers of columns, rows, z-bins and lights in view, but not on
/// how many tiles each light covers. There is no depth test: a light that is left out of a part of its rectangle needs
/// a list.
///
/// A MaskBinner keeps its memory from call to call, as a Binner does. If a call throws, there are no masks, and later
/// calls work as usual. Not thread-safe: use one MaskBinner per thread.
class MaskBinner {
public:
    MaskBinner() = default;
    /// isa  the widest instruction set to use, even where the machine has a wider one. The result is the same.
    explicit MaskBinner(Isa isa) : isa_(isa) {}

    /// Returns the masks of `lights` in `view`. Their memory belongs to the MaskBinner, and is valid until the next
    /// call.
    ///
    /// lights  as for Binner::bin()
    ///
    /// Errors: more than 2^30 lights, or 2^32 - 1 words; a world_space() matrix that is not affine.
    template <class LightRange> Result<LightMasks> bin(const View& view, const LightRange& lights) {
        const auto& source = detail::as_lights(lights);
        if (const auto error = detail::refuse(source)) return *error;
        const detail::DefaultFloatEnvironment environment;
        footprints_.project(machine_isa(isa_), view, source, Parallel());
        return masks_of(view, footprints_.runs(), [](std::uint32_t i) { return i; }, {});
    }

    /// Returns masks with z-bins: the lights are numbered in order of depth, and each slice is a bin that has the range
    /// of the numbers of the lights that meet it. So a shader looks only at the words of its pixel's bin. Order and
    /// ranges are those of a Binner with Slicing::z_bins.
    ///
    /// slices  read only during the call
    template <class LightRange>
    Result<LightMasks> bin(const View& view, const LightRange& lights, const Slices& slices) {
        const auto& source = detail::as_lights(lights);
        if (const auto error = detail::refuse(source)) return *error;
        const detail::DefaultFloatEnvironment environment;
        const Isa isa = machine_isa(isa_);
        constexpr detail::LightKind kind = std::remove_cvref_t<decltype(source)>::kind;
        footprints_.project(isa, view, source, Parallel(), detail::Kept::lights);
        ranked_.rank(detail::depth_buckets_kernel<kind>(isa), view, footprints_, slices);
        const detail::FootprintRun ranks = {0, footprints_.visible()};
        const auto footprint_of = [sources = ranked_.sources()](std::uint32_t rank) { return sources[rank]; };
        return masks_of(view, {&ranks, 1}, footprint_of, ranked_.bins());
    }

private:
    /// runs, footprint_of  as for make_masks()
    template <class FootprintOf>
    Result<LightMasks> masks_of(const View& view, std::span<const detail::FootprintRun> runs, FootprintOf footprint_of,
                                std::span<const BinRange> bins) {
        constexpr std::uint64_t max_words = 0xffffffff;
        const auto columns = static_cast<std::size_t>(view.tiles_x()), rows = static_cast<std::size_t>(view.tiles_y());
        std::size_t each = (footprints_.visible() + std::size_t{31}) / 32;
        // Were masks a power of two apart, those of all columns would lie in the same few sets of a cache.
        each += each > 0 && each % 64 == 0;
        const std::uint64_t masks = columns + rows + std::uint64_t{1},
                            size = 1 + (masks + 32) * each + 2 * std::uint64_t{bins.size()};
        if (size > max_words) return Error{ErrorCode::too_many_entries, size, max_words};

        const detail::FootprintArrays& lights = footprints_.arrays();
        std::uint32_t *const words = words_.reserve(size), *to = words;
        *to++ = static_cast<std::uint32_t>(each);
        detail::make_masks(lights, runs, footprint_of, columns, rows, each, to);
        to += masks * each;
        const std::uint32_t* const end_of_ids = to + 32 * each;
        for (const detail::FootprintRun& run : runs)
            for (std::uint32_t i = run.begin; i < run.end; ++i)
                *to++ = lights.ids[footprint_of(i)];
        while (to < end_of_ids)
            *to++ = 0;
        if (!bins.empty()) std::memcpy(to, bins.data(), bins.size_bytes());
        return LightMasks(view.tiles_x(), view.tiles_y(), {words, static_cast<std::size_t>(size)},
                          footprints_.counts(), bins);
    }

    Isa isa_ = compiled_isa;
    detail::Footprints footprints_;
    detail::RankedFootprints ranked_;
    detail::Buffer<std::uint32_t> words_;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
