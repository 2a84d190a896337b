// mixed.cpp is compiled twice for one program, without optimisation and with.
#pragma once

#include <lightbin/binner.hpp>

#include <cstdint>
#include <span>
#include <vector>

/// The lists of the lights: for each tile how long its list is, and then all ids.
using Lists = std::vector<std::uint32_t>;
Lists unoptimised(lightbin::Binner<>& binner, const lightbin::View& view, std::span<const lightbin::Sphere> lights);
Lists optimised(lightbin::Binner<>& binner, const lightbin::View& view, std::span<const lightbin::Sphere> lights);
