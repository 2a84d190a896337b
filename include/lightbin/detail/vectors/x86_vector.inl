// SPDX-License-Identifier: MIT
// Classes around x86 vector registers: Floats, with the operators of numbers, and Bytes. A tier defines before it
// FloatRegister and IntRegister, the compiler's types of registers, and
//
//   LIGHTBIN_MASK        the type of masks, if they have one bit for each lane; else masks are registers
//   LIGHTBIN_OP(name)    the intrinsic for add, sub, mul, div, sqrt, min, max, set1, xor, andnot, unpacklo, unpackhi,
//                        shuffle; if LIGHTBIN_MASK is not defined, also for and, or, movemask
//   LIGHTBIN_BITS(name)  the intrinsic for and and xor of integers, and for castps
//   LIGHTBIN_INT(name)   the intrinsic for a name that ends in the type of its integers, such as min_epu8
//   load_each_fourth     a register of the sphere at an address and of each fourth one behind it
//   store_each_fourth    the reverse of load_each_fourth
//
// and LIGHTBIN_LESS(a, b), LIGHTBIN_LESS_EQUAL(a, b) and LIGHTBIN_SELECT(mask, a, b).

#if !defined(LIGHTBIN_MASK)
#define LIGHTBIN_MASK FloatRegister  // the bits of each lane are all 1 or all 0
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

struct Floats {
    Floats() = default;
    Floats(FloatRegister value) : v(value) {}
    Floats(float each) : v(LIGHTBIN_OP(set1)(each)) {}
    operator FloatRegister() const { return v; }

    FloatRegister v;
};

inline Floats broadcast(float each) {
    return each;
}
inline Floats operator+(Floats a, Floats b) {
    return LIGHTBIN_OP(add)(a.v, b.v);
}
inline Floats operator-(Floats a, Floats b) {
    return LIGHTBIN_OP(sub)(a.v, b.v);
}
inline Floats operator*(Floats a, Floats b) {
    return LIGHTBIN_OP(mul)(a.v, b.v);
}
inline Floats operator/(Floats a, Floats b) {
    return LIGHTBIN_OP(div)(a.v, b.v);
}
inline Floats operator-(Floats a) {
    return LIGHTBIN_OP(xor)(a.v, broadcast(-0.0f));
}
inline Floats sqrt(Floats a) {
    return LIGHTBIN_OP(sqrt)(a.v);
}

/// Returns a product that is rounded before anything is added to it, see rounded().
inline Floats mul(Floats a, Floats b) {
    Floats product = a * b;
    LIGHTBIN_FORGET(product.v);
    return product;
}

inline Floats abs(Floats a) {
    return LIGHTBIN_OP(andnot)(broadcast(-0.0f), a.v);
}
inline Floats minimum(Floats a, Floats b) {
    return LIGHTBIN_OP(min)(a.v, b.v);
}
inline Floats maximum(Floats a, Floats b) {
    return LIGHTBIN_OP(max)(a.v, b.v);
}
inline LIGHTBIN_MASK less(Floats a, Floats b) {
    return LIGHTBIN_LESS(a.v, b.v);
}
inline LIGHTBIN_MASK less_equal(Floats a, Floats b) {
    return LIGHTBIN_LESS_EQUAL(a.v, b.v);
}
inline Floats select(LIGHTBIN_MASK mask, Floats a, Floats b) {
    return LIGHTBIN_SELECT(mask, a.v, b.v);
}

/// Transposes the 4x4 floats in each group of four lanes of four vectors.
inline void transpose(Floats& a, Floats& b, Floats& c, Floats& d) {
    const Floats low = LIGHTBIN_OP(unpacklo)(a.v, b.v), high = LIGHTBIN_OP(unpackhi)(a.v, b.v);
    const Floats low_after = LIGHTBIN_OP(unpacklo)(c.v, d.v), high_after = LIGHTBIN_OP(unpackhi)(c.v, d.v);
    a = LIGHTBIN_OP(shuffle)(low.v, low_after.v, 0x44);
    b = LIGHTBIN_OP(shuffle)(low.v, low_after.v, 0xee);
    c = LIGHTBIN_OP(shuffle)(high.v, high_after.v, 0x44);
    d = LIGHTBIN_OP(shuffle)(high.v, high_after.v, 0xee);
}
inline void load_spheres(const Sphere* spheres, Floats& x, Floats& y, Floats& z, Floats& radius) {
    x = load_each_fourth(spheres);
    y = load_each_fourth(spheres + 1);
    z = load_each_fourth(spheres + 2);
    radius = load_each_fourth(spheres + 3);
    transpose(x, y, z, radius);
}
inline void store_spheres(Sphere* spheres, Floats x, Floats y, Floats z, Floats radius) {
    transpose(x, y, z, radius);
    store_each_fourth(spheres, x);
    store_each_fourth(spheres + 1, y);
    store_each_fourth(spheres + 2, z);
    store_each_fourth(spheres + 3, radius);
}
inline Floats ascending_bits(Floats values) {
    const IntRegister bits = LIGHTBIN_BITS(castps)(values.v);
    const IntRegister but_sign = LIGHTBIN_INT(srli_epi32)(LIGHTBIN_INT(srai_epi32)(bits, 31), 1);
    return LIGHTBIN_INT(cvtepi32_ps)(LIGHTBIN_BITS(xor)(bits, but_sign));
}
inline void store_tiles(std::uint32_t* tiles, Floats values) {
    const IntRegister whole = LIGHTBIN_INT(cvttps_epi32)(values.v);
    std::memcpy(tiles, &whole, sizeof whole);
}

struct Bytes {
    IntRegister v;
};

inline Bytes broadcast_byte(unsigned each) {
    return {LIGHTBIN_INT(set1_epi8)(static_cast<char>(each))};
}
inline Bytes operator&(Bytes a, Bytes b) {
    return {LIGHTBIN_BITS(and)(a.v, b.v)};
}
inline Bytes minimum(Bytes a, Bytes b) {
    return {LIGHTBIN_INT(min_epu8)(a.v, b.v)};
}
inline Bytes subtract(Bytes a, Bytes b) {
    return {LIGHTBIN_INT(subs_epu8)(a.v, b.v)};
}

#undef LIGHTBIN_MASK
#undef LIGHTBIN_OP
#undef LIGHTBIN_INT
#undef LIGHTBIN_BITS
#undef LIGHTBIN_LESS
#undef LIGHTBIN_LESS_EQUAL
#undef LIGHTBIN_SELECT
