// SPDX-License-Identifier: MIT
// A class of vectors with the operators of its elements. Included twice a tier, for floats and for doubles, which give
//
//   LIGHTBIN_VECTOR      the class's name
//   LIGHTBIN_ELEMENT     float or double
//   LIGHTBIN_REGISTER    the compiler's type for the register
//   LIGHTBIN_OP(name)    the intrinsic of add, sub, mul, div, sqrt
//
// and functions all_lanes(element) and negated(register), or where masks lie in such registers too, all ones or all
// zeros a lane,
//
//   LIGHTBIN_MASK        the name of their class; LIGHTBIN_OP then has set1, xor, min, max, and, or, andnot, movemask, too
//
// and functions less_lanes, less_equal_lanes and select_lanes of registers.

#if defined(LIGHTBIN_MASK)
LIGHTBIN_TARGET inline LIGHTBIN_REGISTER all_lanes(LIGHTBIN_ELEMENT each) {
    return LIGHTBIN_OP(set1)(each);
}
LIGHTBIN_TARGET inline LIGHTBIN_REGISTER negated(LIGHTBIN_REGISTER a) {
    return LIGHTBIN_OP(xor)(a, all_lanes(LIGHTBIN_ELEMENT(-0.0)));
}
#endif

struct LIGHTBIN_VECTOR {
    LIGHTBIN_VECTOR() = default;
    LIGHTBIN_TARGET LIGHTBIN_VECTOR(LIGHTBIN_REGISTER value) : v(value) {}
    LIGHTBIN_TARGET LIGHTBIN_VECTOR(LIGHTBIN_ELEMENT each) : v(all_lanes(each)) {}
    LIGHTBIN_TARGET operator LIGHTBIN_REGISTER() const { return v; }

    LIGHTBIN_REGISTER v;
};

LIGHTBIN_TARGET inline LIGHTBIN_VECTOR operator+(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(add)(a.v, b.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR operator-(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(sub)(a.v, b.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR operator*(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(mul)(a.v, b.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR operator/(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(div)(a.v, b.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR operator-(LIGHTBIN_VECTOR a) {
    return negated(a.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR sqrt(LIGHTBIN_VECTOR a) {
    return LIGHTBIN_OP(sqrt)(a.v);
}

/// A product that is rounded before it is added to anything, see rounded().
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR mul(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    LIGHTBIN_VECTOR product = a * b;
    LIGHTBIN_FORGET(product.v);
    return product;
}

#if defined(LIGHTBIN_MASK)
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR abs(LIGHTBIN_VECTOR a) {
    return LIGHTBIN_OP(andnot)(all_lanes(LIGHTBIN_ELEMENT(-0.0)), a.v);
}

struct LIGHTBIN_MASK {
    LIGHTBIN_REGISTER v;
};
LIGHTBIN_TARGET inline LIGHTBIN_MASK less(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return {less_lanes(a.v, b.v)};
}
LIGHTBIN_TARGET inline LIGHTBIN_MASK less_equal(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return {less_equal_lanes(a.v, b.v)};
}
LIGHTBIN_TARGET inline LIGHTBIN_MASK both(LIGHTBIN_MASK a, LIGHTBIN_MASK b) {
    return {LIGHTBIN_OP(and)(a.v, b.v)};
}
LIGHTBIN_TARGET inline LIGHTBIN_MASK either(LIGHTBIN_MASK a, LIGHTBIN_MASK b) {
    return {LIGHTBIN_OP(or)(a.v, b.v)};
}
LIGHTBIN_TARGET inline LIGHTBIN_MASK and_not(LIGHTBIN_MASK a, LIGHTBIN_MASK b) {
    return {LIGHTBIN_OP(andnot)(b.v, a.v)};
}
LIGHTBIN_TARGET inline unsigned bits(LIGHTBIN_MASK mask) {
    return static_cast<unsigned>(LIGHTBIN_OP(movemask)(mask.v));
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR select(LIGHTBIN_MASK mask, LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return select_lanes(mask.v, a.v, b.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR lesser(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(min)(a.v, b.v);
}
LIGHTBIN_TARGET inline LIGHTBIN_VECTOR greater(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(max)(a.v, b.v);
}
#undef LIGHTBIN_MASK
#endif

#undef LIGHTBIN_VECTOR
#undef LIGHTBIN_ELEMENT
#undef LIGHTBIN_REGISTER
#undef LIGHTBIN_OP
