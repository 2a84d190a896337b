#include "mixed.hpp"

Lists UNIT(lightbin::Binner<>& binner, const lightbin::View& view, std::span<const lightbin::Sphere> lights) {
    const auto grid = binner.bin(view, lights);
    Lists lists;
    if (!grid) return lists;
    for (const auto& range : grid->ranges()) lists.push_back(range.count);
    lists.insert(lists.end(), grid->ids().begin(), grid->ids().end());
    return lists;
}
