// SPDX-License-Identifier: MIT
// What the vectors of all tiers have in common. Included once a tier, after its Floats, Doubles and sqrt;
// +, -, /, comparisons and scalar operands come from the compilers' vector extensions. Reals is either type.
// A tier with mask registers has its own less, less_equal and select, which win over these.

template <class Real> struct VectorOf { using Type = Floats; };
template <> struct VectorOf<double> { using Type = Doubles; };

/// Every lane the same.
template <class Real> LIGHTBIN_TARGET inline typename VectorOf<Real>::Type all(Real value) {
    return value - typename VectorOf<Real>::Type{};
}

LIGHTBIN_TARGET inline Floats load_floats(const float* from) {
    Floats values;
    std::memcpy(&values, from, sizeof values);
    return values;
}
LIGHTBIN_TARGET inline void store_floats(float* to, Floats values) {
    std::memcpy(to, &values, sizeof values);
}

/// A product that is rounded before it is added to anything, see rounded().
template <class Reals> LIGHTBIN_TARGET inline Reals mul(Reals a, Reals b) {
    Reals product = a * b;
    LIGHTBIN_ROUND(product);
    return product;
}

template <class Reals> LIGHTBIN_TARGET inline auto less(Reals a, Reals b) {
    return a < b;
}
template <class Reals> LIGHTBIN_TARGET inline auto less_equal(Reals a, Reals b) {
    return a <= b;
}
template <class Mask, class Reals> LIGHTBIN_TARGET inline Reals select(Mask mask, Reals a, Reals b) {
    return mask ? a : b;
}

// With NaN in `a`, b.
template <class Reals> LIGHTBIN_TARGET inline Reals lesser(Reals a, Reals b) {
    return a < b ? a : b;
}
template <class Reals> LIGHTBIN_TARGET inline Reals greater(Reals a, Reals b) {
    return a > b ? a : b;
}
template <class Reals> LIGHTBIN_TARGET inline Reals abs(Reals a) {
    return greater(-a, a);
}

template <class Mask> LIGHTBIN_TARGET inline Mask both(Mask a, Mask b) {
    return static_cast<Mask>(a & b);
}
template <class Mask> LIGHTBIN_TARGET inline Mask either(Mask a, Mask b) {
    return static_cast<Mask>(a | b);
}
template <class Mask> LIGHTBIN_TARGET inline Mask both_not(Mask a, Mask b) {
    return static_cast<Mask>(a & (a ^ b));
}
