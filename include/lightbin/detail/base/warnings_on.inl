// SPDX-License-Identifier: MIT
// The user's own warnings again, see warnings_off.inl.
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic pop
#endif
