// SPDX-License-Identifier: MIT
// What kernels ask of vectors, of those that have the operators of numbers: numbers themselves, one a vector, and those of
// NEON, which compilers give them. Included once such a tier.

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
// With NaN in `a`, b: NEON's own instructions for it give NaN.
template <class Reals> Reals minimum(Reals a, Reals b) {
    return a < b ? a : b;
}
template <class Reals> Reals maximum(Reals a, Reals b) {
    return a > b ? a : b;
}
template <class Reals> Reals abs(Reals a) {
    return maximum(-a, a);
}
