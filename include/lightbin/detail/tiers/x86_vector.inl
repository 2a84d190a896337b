// SPDX-License-Identifier: MIT
// A class around an x86 vector register, with the operators of its elements. A tier includes this file twice, for
// floats and for doubles, and defines before it
//
//   LIGHTBIN_VECTOR    the name of the class
//   LIGHTBIN_ELEMENT   float or double
//   LIGHTBIN_REGISTER  the compiler's type of register
//   LIGHTBIN_MASK      the type of masks, if they have one bit for each lane; else masks are registers
//   LIGHTBIN_OP(name)  the intrinsic for add, sub, mul, div, sqrt, min, max, set1, xor, andnot; if LIGHTBIN_MASK is not
//                      defined, also for and, or, movemask
//
// and, for both types of elements, LIGHTBIN_LESS(a, b), LIGHTBIN_LESS_EQUAL(a, b) and LIGHTBIN_SELECT(mask, a, b).

#if !defined(LIGHTBIN_MASK)
#define LIGHTBIN_MASK LIGHTBIN_REGISTER  // the bits of each lane are all 1 or all 0
inline LIGHTBIN_MASK both(LIGHTBIN_MASK a, LIGHTBIN_MASK b) {
    return LIGHTBIN_OP(and)(a, b);
}
inline LIGHTBIN_MASK either(LIGHTBIN_MASK a, LIGHTBIN_MASK b) {
    return LIGHTBIN_OP(or)(a, b);
}
inline LIGHTBIN_MASK and_not(LIGHTBIN_MASK a, LIGHTBIN_MASK b) {
    return LIGHTBIN_OP(andnot)(b, a);
}
inline unsigned movemask(LIGHTBIN_MASK mask) {
    return static_cast<unsigned>(LIGHTBIN_OP(movemask)(mask));
}
#endif

struct LIGHTBIN_VECTOR {
    LIGHTBIN_VECTOR() = default;
    LIGHTBIN_VECTOR(LIGHTBIN_REGISTER value) : v(value) {}
    LIGHTBIN_VECTOR(LIGHTBIN_ELEMENT each) : v(LIGHTBIN_OP(set1)(each)) {}
    operator LIGHTBIN_REGISTER() const { return v; }

    LIGHTBIN_REGISTER v;
};

inline LIGHTBIN_VECTOR broadcast(LIGHTBIN_ELEMENT each) {
    return each;
}
inline LIGHTBIN_VECTOR operator+(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(add)(a.v, b.v);
}
inline LIGHTBIN_VECTOR operator-(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(sub)(a.v, b.v);
}
inline LIGHTBIN_VECTOR operator*(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(mul)(a.v, b.v);
}
inline LIGHTBIN_VECTOR operator/(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(div)(a.v, b.v);
}
inline LIGHTBIN_VECTOR operator-(LIGHTBIN_VECTOR a) {
    return LIGHTBIN_OP(xor)(a.v, broadcast(LIGHTBIN_ELEMENT(-0.0)));
}
inline LIGHTBIN_VECTOR sqrt(LIGHTBIN_VECTOR a) {
    return LIGHTBIN_OP(sqrt)(a.v);
}

/// Returns a product that is rounded before anything is added to it, see rounded().
inline LIGHTBIN_VECTOR mul(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    LIGHTBIN_VECTOR product = a * b;
    LIGHTBIN_FORGET(product.v);
    return product;
}

inline LIGHTBIN_VECTOR abs(LIGHTBIN_VECTOR a) {
    return LIGHTBIN_OP(andnot)(broadcast(LIGHTBIN_ELEMENT(-0.0)), a.v);
}
inline LIGHTBIN_VECTOR minimum(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(min)(a.v, b.v);
}
inline LIGHTBIN_VECTOR maximum(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_OP(max)(a.v, b.v);
}
inline LIGHTBIN_MASK less(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_LESS(a.v, b.v);
}
inline LIGHTBIN_MASK less_equal(LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_LESS_EQUAL(a.v, b.v);
}
inline LIGHTBIN_VECTOR select(LIGHTBIN_MASK mask, LIGHTBIN_VECTOR a, LIGHTBIN_VECTOR b) {
    return LIGHTBIN_SELECT(mask, a.v, b.v);
}

#undef LIGHTBIN_VECTOR
#undef LIGHTBIN_ELEMENT
#undef LIGHTBIN_REGISTER
#undef LIGHTBIN_MASK
#undef LIGHTBIN_OP
