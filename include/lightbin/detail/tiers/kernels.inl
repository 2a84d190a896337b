// SPDX-License-Identifier: MIT
// The kernels of one tier, in order: every text is read once for each tier, in the tier's namespace and with its vector class. A
// tier is a file that defines what is named below and includes this one; a kernel is a text, a line here, a member of Tier, and a
// function in kernels.hpp that hands it out.
//
// A tier defines LIGHTBIN_TIER, the name of its namespace, and in that
//   lanes, double_lanes            the number of floats, and of doubles, in a vector
//   Floats, Doubles                vectors with + - * / and the sign
//   FloatRegister, DoubleRegister  the compiler's types that hold them
//   broadcast, sqrt, abs           of a number into all lanes; of each lane
//   mul                            a product that is rounded before anything is added to it, see rounded()
//   less, less_equal               comparisons; the result is a mask
//   movemask                       the bits of a mask, one a lane
//   both, either, and_not          logic of masks, unless these have & | ^
//   select(mask, a, b)             a where the mask is set, else b
//   minimum, maximum               of two vectors; where a lane of the first is NaN, the second's
//   widened(floats, half)          half 0 or 1 of Floats as Doubles
//   load_spheres, store_spheres    `lanes` spheres as four vectors, and back
//   store_tiles, store_spans       coordinates of tiles, rounded down to whole numbers; pairs of them as 16 bits
//   ascending_bits                 the bits of floats as numbers in the order of the floats, as floats
//   split_bits(bytes, words)       for each of the 8 bits of 64 bytes the word of that bit in each: a transpose of 64x8 bits
//   split_16_bytes(bytes, words)   the same of 16 bytes
//   append_16(out, ids, mask)      appends those of 16 ids whose bit is set, and up to 16 elements without meaning; the end
//   append_8                       the same of 8 ids, with up to 16 elements without meaning
//   Bytes, ByteMask, byte_lanes    a vector of bytes without sign, a bit for each, how many
//   load_bytes, store_bytes, broadcast_byte, &, minimum
//   subtract                       0 where the difference is negative
//   shuffle(table, indices)        looks up bytes in a table of 16
//   not_zero                       the mask of the bytes that are not 0
//   keep_where(bytes, condition)   the bytes whose condition is not 0; the others become 0
//   coordinates(from, more, begin) min(from[i] + more - begin, 255), 0 where negative, of `byte_lanes` 16-bit numbers
//   compress_store(mask, from, to) stores the chosen bytes, or 32-bit ids in memory, side by side, and elements without meaning
// Functions that a tier has a faster way for overload those of common.inl.

#define LIGHTBIN_KERNELS

#include <lightbin/detail/tiers/common.inl>

#include <lightbin/detail/depth/depth_columns.inl>

#include <lightbin/detail/depth/slice_indices.inl>

#include <lightbin/detail/project/world_to_view.inl>

#include <lightbin/detail/project/spheres.inl>

#include <lightbin/detail/project/spot_vectors.inl>

#include <lightbin/detail/project/spots.inl>

#include <lightbin/detail/project/sphere_rows.inl>

#include <lightbin/detail/project/spot_rows.inl>

#include <lightbin/detail/engine/lists.inl>

#include <lightbin/detail/engine/cells.inl>

#include <lightbin/detail/engine/depth_tests.inl>

#include <lightbin/detail/engine/emit.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The tier's kernels, for kernels.hpp.
struct Tier {
    static constexpr std::size_t vector = lanes;

    template <bool spots> static ProjectKernel project_kernel() {
        if constexpr (spots)
            return project_spots;
        else
            return project;
    }
    template <bool spots> static RowSpanKernel row_span_kernel() {
        return row_spans<std::conditional_t<spots, SpotRows, SphereRows>>;
    }
    template <bool spots> static DepthBucketsKernel depth_buckets_kernel() { return find_depth_buckets<spots>; }
    template <bool by_split> static DepthKernel depth_kernel() { return column_extremes<by_split>; }

    template <Footprint footprint, DepthTest depth_test, class Id, bool by_slab, bool spots>
    static BinKernel<Id> bin_kernel() {
        if constexpr (lanes == 1 && !has_tests<footprint, depth_test>)
            return scatter_lights<Id>;  // as scatter_is_faster() says of the scalar tier
        else
            return bin_blocks<footprint, depth_test, Id, by_slab, spots>;
    }
    template <Footprint footprint, DepthTest depth_test, class Id, bool spots> static BitsKernel<Id> bits_kernel() {
        return write_bits<footprint, depth_test, Id, spots>;
    }
};

}}}}  // namespace lightbin::detail

#undef LIGHTBIN_KERNELS
#undef LIGHTBIN_TIER_EMITS_SHORT
#undef LIGHTBIN_TIER
