// SPDX-License-Identifier: MIT
// Warnings that users have on and that mean nothing here, off from where a header includes this until it includes
// warnings_on.inl:
//
//   -Wfloat-equal   where numbers are compared for equality, exactly that is asked
//   -Wcast-align    the instructions that load and store vectors take any address
//   -Wuseless-cast  what std::size_t is, and so which cast changes nothing, depends on the machine
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wfloat-equal"
#pragma GCC diagnostic ignored "-Wcast-align"
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuseless-cast"
#endif
#endif
