// SPDX-License-Identifier: MIT
// Turns off warnings that users may have on, from where a header includes this file until it includes warnings_on.inl.
// They are about code that is meant as it is:
//
//   -Wfloat-equal   floats are compared for exact equality on purpose
//   -Wcast-align    vector load and store instructions accept any address
//   -Wuseless-cast  a cast to std::size_t changes the type on some machines only
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wfloat-equal"
#pragma GCC diagnostic ignored "-Wcast-align"
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuseless-cast"
#endif
#endif
