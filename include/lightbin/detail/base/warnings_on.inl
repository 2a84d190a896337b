// SPDX-License-Identifier: MIT
// Restores the user's warnings after warnings_off.inl.
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic pop
#endif
