// SPDX-License-Identifier: MIT
// The text of all kernels, in one order: a tier is a file that opens a namespace of its own, defines what is named
// below, includes this once and closes. A new kernel is its text, a line here and a line in Tier; a new tier is a
// file, and a line in kernels.hpp.
//
// A tier defines
//                  what its functions are declared with: their instructions
//   lanes, double_lanes            floats and doubles in a vector
//   FloatRegister, DoubleRegister  the compiler's types for what they lie in
//   Floats, Doubles                vectors with + - * / and a sign (vector.inl, numbers.inl);
//   all, sqrt, abs, mul            all: of one number for all lanes; mul: a product that is rounded
//   less, less_equal               of two vectors: a mask
//   bits                           of a mask, a bit a lane; and if masks have no & | ^, both, either, and_not
//   select, lesser, greater        a where the mask is set, else b; with NaN in a, b
//   widened                        half 0 or 1 of Floats as Doubles
//   load_spheres, store_spheres    `lanes` spheres as four vectors, and back
//   store_tiles, store_spans       numbers of tiles, cut off to 16 bits
//   ascending_bits                 floats' bits as numbers that ascend with them, rounded to floats
//   split_bits                     as in portable.hpp, or that
//   ListId                         of what the lists are made: std::uint32_t, or std::uint16_t where ids are in blocks
// for step 3, emit.inl,
//   transpose_words                as in portable.hpp, or that
//   Packed, packs_ids, append      ids in the form that append() takes, see portable.hpp and sse2.hpp
//   append_lights                  with vectors of bytes: the same of ids and columns
// or
//   LIGHTBIN_TIER_COMPRESSES       defined: emits by emit_compress.inl; scatters, arranges cells and
//                                  writes bits as AVX2 does; load_listed_spheres as in cells.inl
// for step 1, lists_scan.inl, where it has fast vectors of bytes,
//   LIGHTBIN_TIER_HAS_BYTES        defined: and so are these
//   Bytes, ByteMask, byte_lanes    a vector of bytes without sign, a bit a byte, how many
//   load_bytes, all_bytes          from memory; every byte the same
//   &, lesser, subtract            of two vectors; a difference is not less than 0
//   look_up, not_zero              in a table of 16 bytes; which bytes are not 0
//   coordinates                    how far as many numbers of 16 bits, plus `more`, are beyond `begin`: 0 to 255
//   ByteIds, load_ids, count_ids   as many list entries: of ids, of list entries; `first`, first + 1 ...
//   append_visible                 as the general one of vectors.inl
//   append_chosen                  stores the chosen bytes or entries side by side, and then what means nothing
// for scatter.inl, where it has vectors of counts,
//   LIGHTBIN_TIER_HAS_ROWS         defined: has Rows and Tiles

#define LIGHTBIN_KERNELS

#include <lightbin/detail/tiers/common.inl>

#include <lightbin/detail/depth/depth_columns.inl>

#include <lightbin/detail/project/world_to_view.inl>

#include <lightbin/detail/project/eights.inl>

#include <lightbin/detail/project/spheres.inl>

#include <lightbin/detail/project/spot_vectors.inl>

#include <lightbin/detail/project/spots.inl>

#include <lightbin/detail/project/sphere_rows.inl>

#include <lightbin/detail/project/spot_rows.inl>

#if defined(LIGHTBIN_TIER_HAS_BYTES)
#include <lightbin/detail/engine/lists.inl>
#else
#include <lightbin/detail/engine/lists_insert.inl>
#endif

#if defined(LIGHTBIN_TIER_COMPRESSES)
#include <lightbin/detail/engine/slab.inl>

#include <lightbin/detail/engine/emit_compress.inl>
#else
#include <lightbin/detail/engine/scatter.inl>

#include <lightbin/detail/engine/cells.inl>

#include <lightbin/detail/engine/slab.inl>

#include <lightbin/detail/engine/emit.inl>
#endif

#include <lightbin/detail/depth/slice_indices.inl>

#include <lightbin/detail/engine/depth_tests.inl>

#if !defined(LIGHTBIN_TIER_COMPRESSES)
#include <lightbin/detail/engine/bits.inl>
#endif

#include <lightbin/detail/engine/bin.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// What the tier hands out, see kernels.hpp.
struct Tier {
    static constexpr std::size_t vector = lanes;

    template <bool spots> static ProjectKernel project_kernel() {
        if constexpr (spots)
            return project_spots;
        else
            return project;
    }
    template <bool spots> static RowSpanKernel row_span_kernel() { return row_spans<std::conditional_t<spots, SpotRows, SphereRows>>; }
    template <bool spots> static SlicePlacesKernel slice_places_kernel() { return slice_places<spots>; }
    template <bool by_split> static DepthKernel depth_kernel() { return column_extremes<by_split>; }

    template <Footprint footprint, DepthTest depth_test, class Id, bool by_slab, bool spots>
    static BinKernel<Id> bin_kernel() {
        return bin_supertiles<footprint, depth_test, Id, by_slab, spots>;
    }

    template <Footprint footprint, DepthTest depth_test, class Id, bool spots>
    static BitsKernel<Id> bits_kernel() {
#if defined(LIGHTBIN_TIER_COMPRESSES)
        return avx2::Tier::bits_kernel<footprint, depth_test, Id, spots>();
#else
        return write_bits<footprint, depth_test, Id, spots>;
#endif
    }

    template <class Id> static BinKernel<Id> scatter_kernel() {
#if defined(LIGHTBIN_TIER_COMPRESSES)
        return avx2::Tier::scatter_kernel<Id>();
#else
        return bin_scatter<Id>;
#endif
    }
};

}}}}  // namespace lightbin::detail

#undef LIGHTBIN_KERNELS
#undef LIGHTBIN_TIER
#undef LIGHTBIN_LESS
#undef LIGHTBIN_LESS_EQUAL
#undef LIGHTBIN_SELECT
#undef LIGHTBIN_TIER_HAS_ROWS
#undef LIGHTBIN_TIER_HAS_BYTES
#undef LIGHTBIN_TIER_COMPRESSES
