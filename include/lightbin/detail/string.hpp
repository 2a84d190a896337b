// SPDX-License-Identifier: MIT
// The name of std::string. Those who make strings in the core are templates: it is enough for them that their callers have
// included <string>, which takes 0.05 s to compile.
#pragma once

#include <iosfwd>

// Of the libraries that have no std::string in it.
#if !defined(__GLIBCXX__) && !defined(_LIBCPP_VERSION)
#include <string>
#endif
