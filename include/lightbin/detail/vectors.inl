// SPDX-License-Identifier: MIT
// What the vectors of all tiers have in common, written once. Included once a tier, after its vectors and masks. Reals is
// either type of vector.

template <class Real> struct VectorOf { using Type = Floats; };
template <> struct VectorOf<double> { using Type = Doubles; };

/// Every lane the same.
template <class Real> LIGHTBIN_TARGET inline typename VectorOf<Real>::Type all(Real value) {
    return typename VectorOf<Real>::Type(value);
}

LIGHTBIN_TARGET inline Floats load_floats(const float* from) {
    Floats values;
    std::memcpy(&values, from, sizeof values);
    return values;
}
LIGHTBIN_TARGET inline void store_floats(float* to, Floats values) {
    std::memcpy(to, &values, sizeof values);
}

template <class Reals> LIGHTBIN_TARGET inline Reals abs(Reals a) {
    return greater(-a, a);
}

/// As select, of what no processor predicts: the scalar tier has its own of floats, without a branch.
template <class Mask, class Reals>
LIGHTBIN_TARGET inline Reals select_unpredicted(Mask mask, Reals a, Reals b) {
    return select(mask, a, b);
}
