// SPDX-License-Identifier: MIT
// The ranking stage, between projection and binning: sorts footprints by depth, and finds for each depth slice, which
// is a z-bin here, the range of their ranks (see Slicing::z_bins).
#pragma once

#include <lightbin/detail/stages/footprints.hpp>
#include <lightbin/slices.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The footprints of lights sorted by the first z-bin, an interval of view depth, that the light meets, and in the
/// caller's order within a z-bin. A footprint's rank is its index in this order; lists have ranks in place of ids.
/// Memory is reused from call to call.
class RankedFootprints {
public:
    /// Finds the z-bins, intervals of view depth, that each light meets, and sorts the footprints by the first of them.
    /// A light's view depths, a sphere's being z - r to z + r, include their ends and are widened by the slices'
    /// margin.
    ///
    /// kernel  find_depth_buckets() for the lights' kind
    void order(DepthBucketsKernel kernel, const View& view, const Footprints& footprints,
               const Slices& slices) {
        rank(kernel, view, footprints, slices);
        area_ = footprints.area();
        gather_lights(footprints.arrays());
    }

    /// Finds what order() does, but leaves the footprints where they are: only sources() and bins() are valid after it.
    void rank(DepthBucketsKernel kernel, const View& view, const Footprints& footprints,
              const Slices& slices) {
        run_ = {0, footprints.visible()};
        bin_count_ = static_cast<std::size_t>(slices.count());
        const std::uint32_t size = footprints.runs().back().end;
        std::uint32_t *const ends = ends_.reserve(bin_count_), *const sources = sources_.reserve(run_.end);
        std::uint32_t *const first_bins = first_bins_.reserve(size), *const last_bins = last_bins_.reserve(size);
        fill_items(ends, bin_count_, 0);
        const auto found = [=](std::uint32_t i, SliceTable::Range met) {
            first_bins[i] = met.first;
            last_bins[i] = met.last;
            ++ends[met.first];
        };
        table_of(slices).find(kernel, camera_of(view).z_sign, footprints.arrays(), footprints.runs(), found);

        // A counting sort: ends_ has the number of lights that begin in each bin, then the rank of the first of them,
        // and at last the rank after the last of them.
        std::uint32_t before = 0;
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            const std::uint32_t begin = before;
            before += ends[bin];
            ends[bin] = begin;
        }
        // Only the footprints' indices are scattered here. By these indices the arrays of footprints are then gathered,
        // as scattered reads are faster than scattered writes.
        for (const FootprintRun& run : footprints.runs())
            for (std::uint32_t i = run.begin; i < run.end; ++i)
                sources[ends[first_bins[i]]++] = i;
        find_ranges();
    }

    /// For each rank, the index of the footprint in the arrays that were given.
    std::span<const std::uint32_t> sources() const { return {sources_.data(), run_.end}; }
    std::span<const BinRange> bins() const { return {bins_.data(), bin_count_}; }

    FootprintSlice all() const { return {arrays_, {&run_, 1}, run_.end, area_}; }
    LightRanks ranks() const { return {{order_.data(), run_.end}, bins()}; }

private:
    /// Writes the sorted footprints array by array, so that few cache lines are read in random order at a time.
    void gather_lights(const FootprintArrays& lights) {
        arrays_ = buffers_.reserve(run_.end);
        std::uint32_t* const order = order_.reserve(run_.end);
        gather(lights.ids, order);
        for (std::uint32_t rank = 0; rank < run_.end; ++rank)
            arrays_.ids[rank] = rank;
        gather(lights.x0, arrays_.x0);
        gather(lights.y0, arrays_.y0);
        gather(lights.x1, arrays_.x1);
        gather(lights.y1, arrays_.y1);
        arrays_.by_rank = order;
        arrays_.view_lights = lights.view_lights;
    }

    template <class T> void gather(const T* from, T* to) const {
        const std::uint32_t* const sources = sources_.data();
        for (std::uint32_t rank = 0; rank < run_.end; ++rank)
            to[rank] = from[sources[rank]];
    }

    /// Finds, for each z-bin, the least and the greatest rank of the lights that meet it. A light's rank is its place
    /// in the order of the first z-bins that lights meet.
    void find_ranges() {
        const std::uint32_t *const sources = sources_.data(), *const last_bins = last_bins_.data();
        BinRange* const bins = bins_.reserve(bin_count_);
        // A bin's least rank is the rank of the first light that ends in the bin or a later one: lights before it end
        // too early. Lights after it begin no earlier than it. So if it begins only after the bin, no light meets the
        // bin, which the last loop below marks as empty.
        BinRange *to = bins, *const end = bins + bin_count_;
        for (std::uint32_t rank = 0; rank < run_.end && to < end; ++rank)
            for (const BinRange* last = bins + last_bins[sources[rank]]; to <= last; ++to)
                to->least = rank;
        fill_items(to, static_cast<std::size_t>(end - to), {0xffffffff, 0});
        // A bin's greatest rank is the rank of the last light that begins in the bin or an earlier one; if that light
        // ends before the bin, of the light before it, and so on. skip[rank] is how many lights directly before the
        // light with this rank are known to have ended, so that each of them is passed only once.
        std::uint32_t* const skip = first_bins_.data();  // reused: the first bins are no longer needed
        fill_items(skip, run_.end, 0);
        for (std::size_t bin = 0; bin < bin_count_; ++bin) {
            const std::uint32_t count = ends_.data()[bin];
            if (count <= bins[bin].least) {
                bins[bin] = {1, 0};  // least > greatest: no light meets the bin
                continue;
            }
            std::uint32_t rank = count - 1;
            while (last_bins[sources[rank]] < bin)
                rank -= 1 + skip[rank];
            if (rank < count - 1) skip[count - 1] = count - 2 - rank;
            bins[bin].greatest = rank;
        }
    }

    /// For each footprint, by its index before sorting by z-bin: the first and the last z-bin that its light meets.
    Buffer<std::uint32_t> first_bins_, last_bins_;
    Buffer<std::uint32_t> sources_;  ///< for each rank, the index of the footprint before sorting
    Buffer<std::uint32_t> order_;    ///< for each rank (place in order of depth), the id of the light
    Buffer<std::uint32_t> ends_;     ///< for each z-bin, the number of lights that begin in it or before it
    Buffer<BinRange> bins_;
    FootprintBuffers buffers_;
    FootprintArrays arrays_ = {};
    FootprintRun run_ = {};
    std::uint64_t area_ = 0;
    std::size_t bin_count_ = 0;
};

}}}  // namespace lightbin::detail
