// One Binner: with every option off, or with ALL_OPTIONS on, and a Budget. left_out.sh compares the two.
#include <lightbin/binner.hpp>
#if defined(ALL_OPTIONS)
#include <lightbin/budget.hpp>
#endif

#include <cstddef>
#include <cstdint>
#include <span>

std::uint64_t bin(const lightbin::View& view, std::span<const lightbin::Sphere> lights,
                  const lightbin::ZBounds& bounds, void (*run)(std::size_t)) {
#if defined(ALL_OPTIONS)
    static_cast<void>(run);
    const auto loop = [run](std::size_t n, const auto& body) {
        for (std::size_t i = 0; i < n; ++i) {
            run(i);
            body(i);
        }
    };
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner;
    const auto grid = binner.bin(view, lights, {.bounds = bounds}, lightbin::Parallel(4, loop));
    lightbin::Binner<lightbin::Options{.depth_test = true, .slicing = lightbin::Slicing::clusters}> cluster_binner;
    const auto clusters = cluster_binner.bin(view, lights, {.slices = *lightbin::Slices::linear(8, 0, 100)});
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::z_bins}> ranking_binner;
    const auto ranked = ranking_binner.bin(view, lights, {.slices = *lightbin::Slices::linear(8, 0, 100)});
    lightbin::Budget<> budget;
    const auto limited = budget.limit(*clusters, {}, {.per_cell = 9});
    return grid && clusters && ranked && limited
               ? grid->ids().size() + clusters->ids().size() + ranked->ids().size()
               : 0;
#else
    static_cast<void>(bounds);
    static_cast<void>(run);
    lightbin::Binner<> binner;
    const auto grid = binner.bin(view, lights);
    return grid ? grid->ids().size() : 0;
#endif
}
