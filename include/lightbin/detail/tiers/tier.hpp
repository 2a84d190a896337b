// SPDX-License-Identifier: MIT
// What every tier (the kernels of one instruction set) includes: the headers that the kernels' texts (.inl) need, the
// types of the kernels, and a table of the shuffles that move chosen elements to the front of a vector.
#pragma once

#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/detail/engine/scatter.hpp>
#include <lightbin/spot.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

// What kernels.inl hands out of each tier.
using ProjectKernel = void (*)(const Camera& camera, const LightSource& source, std::uint32_t first,
                               std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts);
using RowSpanKernel = void (*)(const Camera& camera, const FootprintArrays& lights, FootprintRun run,
                               RowSpan* spans, std::uint64_t place);
using DepthBucketsKernel = void (*)(const DepthBuckets& to, float z_sign, const FootprintArrays& lights,
                                   const std::uint32_t* ids, std::uint32_t count, LightDepths& out);
using DepthKernel = void (*)(const DepthRows& depth, float skipped, const float* split, float* lower,
                             float* upper);
template <class Id>
using BinKernel = std::uint64_t (*)(const BinJob<Id>& job, Scratch& scratch, const BinShare<Id>& share);
template <class Id>
using BitsKernel = void (*)(const BinJob<Id>& job, Scratch& scratch, unsigned begin, unsigned end,
                            std::uint32_t* bits, std::size_t stride);

/// For each value of a byte, the positions of its set bits in ascending order, one in each byte of a word. As indices
/// of a shuffle they compact eight elements: they move the elements whose bit is set to the front.
struct SetBits {
    std::uint64_t of[256];
};
inline constexpr SetBits set_bits = [] {
    SetBits table = {};
    for (unsigned byte = 1; byte < 256; ++byte)
        table.of[byte] = table.of[byte & (byte - 1)] << 8 | static_cast<unsigned>(std::countr_zero(byte));
    return table;
}();

}}}  // namespace lightbin::detail
