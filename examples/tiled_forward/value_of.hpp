// SPDX-License-Identifier: MIT
// What lightbin returns, or its reason as an exception.
#pragma once

#include <lightbin/result.hpp>

#include <stdexcept>

template <class T> T value_of(lightbin::Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message());
    return *result;
}
