// SPDX-License-Identifier: MIT
// Vector functions for types that have the operators of numbers themselves: plain numbers in the scalar tier, and the
// vector types of GCC and Clang in NEON and WebAssembly.

template <class Reals> Reals mul(Reals a, Reals b) {
    return rounded(a * b);
}
template <class Reals> auto less(Reals a, Reals b) {
    return a < b;
}
template <class Reals> auto less_equal(Reals a, Reals b) {
    return a <= b;
}
template <class Mask, class Reals> Reals select(Mask mask, Reals a, Reals b) {
    return mask ? a : b;
}
// Where a is NaN these return b, as the kernels need. NEON's instructions for minimum and maximum would return NaN.
template <class Reals> Reals minimum(Reals a, Reals b) {
    return a < b ? a : b;
}
template <class Reals> Reals maximum(Reals a, Reals b) {
    return a > b ? a : b;
}
template <class Reals> Reals abs(Reals a) {
    return maximum(-a, a);
}
