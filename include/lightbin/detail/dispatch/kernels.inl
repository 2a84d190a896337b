// SPDX-License-Identifier: MIT
// The kernels of one tier (instruction set). The source of a kernel is an .inl file of templates over the tier's vector
// class. This file includes all kernels but those of spots and boxes, which shape_kernels.inl includes, and each after
// the files whose functions it calls. tiers.hpp includes this file once for each tier, so that each kernel is compiled
// in the tier's namespace. A kernel also has a member in Tier, at the end of this file, and a function in kernels.hpp
// that returns it.
//
// LIGHTBIN_TIER is the name of that namespace. In it, a file of detail/vectors defines
//   lanes                          the number of floats in a vector
//   Floats                         a vector with + - * / and the sign
//   FloatRegister                  the compiler's own type inside of Floats
//   broadcast, sqrt, abs           a number in all lanes; the root, and the absolute value, of each lane
//   mul                            a product that is rounded before anything is added to it, see rounded()
//   less, less_equal               comparisons; the result is a mask
//   movemask                       the bits of a mask, one for each lane, as an integer
//   both, either, and_not          logic of masks, unless masks have & | ^
//   select(mask, a, b)             a where the mask is set, else b
//   minimum, maximum               of two vectors; where a lane of the first is NaN, the second's
//   load_spheres, store_spheres    `lanes` spheres as four vectors, and back
//   store_tiles                    coordinates of tiles, rounded down to whole numbers
//   ascending_bits                 the bits of floats as numbers in the order of the floats, as floats
//   append_16(out, ids, mask)      appends the ids, of 16, whose bit is set; returns the end; writes up to 16 more
//   append_8(out, ids, mask)       as append_16(), but of 8 ids
//   Bytes, ByteMask, byte_lanes    a vector of unsigned bytes; a mask with a bit for each; the number of bytes
//   load_bytes, store_bytes, broadcast_byte, &, minimum
//   subtract                       the difference of bytes, 0 where it is negative
//   shuffle(table, indices)        looks up bytes in a table of 16
//   not_zero                       the mask of the bytes that are not 0
//   keep_where(bytes, condition)   the bytes, but 0 where the byte of `condition` is 0
//   coordinates(from, more, begin) min(from[i] + more - begin, 255) of `byte_lanes` 16-bit numbers; 0 where negative
//   compress_store(mask, from, to) stores the chosen bytes side by side, then meaningless elements
// A tier overloads the functions of common.inl for which it has a faster way.

// clang-format off: in this order
#include <lightbin/detail/vectors/common.inl>
#include <lightbin/detail/depth/depth_columns.inl>
#include <lightbin/detail/depth/slice_indices.inl>
#include <lightbin/detail/project/world_to_view.inl>
#include <lightbin/detail/project/spheres.inl>
#include <lightbin/detail/engine/lists.inl>
#include <lightbin/detail/engine/cells.inl>
#include <lightbin/detail/engine/cell_tests.inl>
#include <lightbin/detail/engine/slab_tests.inl>
#include <lightbin/detail/engine/depth_tests.inl>
#include <lightbin/detail/engine/emit.inl>
// clang-format on

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// The tier's kernels, for kernels.hpp.
struct Tier {
    static constexpr std::size_t vector = lanes;

    template <LightKind kind> static ProjectKernel project_kernel() { return project_lights<kind>; }
    template <LightKind kind> static DepthBucketsKernel depth_buckets_kernel() { return find_depth_buckets<kind>; }
    static DepthKernel depth_kernel() { return column_extremes; }

    template <class Id, Tested tested, LightKind kind> static BinKernel<Id> bin_kernel() {
        if constexpr (tested == Tested::nothing && lanes <= (widest_that_scatters == Isa::scalar ? 1 : 4))
            return scatter_lights<Id>;
        else
            return bin_blocks<Id, tested, kind>;
    }
};

}}}}  // namespace lightbin::detail

#undef LIGHTBIN_TIER
