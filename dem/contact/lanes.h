// Lanes of several doubles, rows of four in memory, and the turn between them.
//
// Only for contact/kernel.cc, which is compiled once for each instruction set: DENSIFY_ISA names the namespace, so that
// no function compiled for one processor is ever linked into code for another.  Every operation is the IEEE one of each
// lane: results are the same bits at every width and on every instruction set.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifndef DENSIFY_ISA
#define DENSIFY_ISA baseline
#endif

namespace densify::dem::DENSIFY_ISA {

template <int width>
struct Mask {
  typedef std::int64_t Vector __attribute__((vector_size(8 * width)));
  Vector v;

  friend Mask operator&(const Mask& a, const Mask& b) { return {a.v & b.v}; }
  friend Mask operator|(const Mask& a, const Mask& b) { return {a.v | b.v}; }
};

template <int width>
struct Lanes {
  typedef double Vector __attribute__((vector_size(8 * width)));
  Vector v;

  Lanes() = default;
  Lanes(double x) : v(x - Vector{}) {}  // the same in every lane
  Lanes(const Vector& x) : v(x) {}

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return a.v + b.v; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return a.v - b.v; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return a.v * b.v; }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return a.v / b.v; }
  friend Lanes operator-(const Lanes& a) { return -a.v; }
  friend Mask<width> operator<(const Lanes& a, const Lanes& b) { return {a.v < b.v}; }
  friend Mask<width> operator>(const Lanes& a, const Lanes& b) { return {a.v > b.v}; }
  friend Mask<width> operator<=(const Lanes& a, const Lanes& b) { return {a.v <= b.v}; }
  friend Mask<width> operator>=(const Lanes& a, const Lanes& b) { return {a.v >= b.v}; }
  friend Lanes select(const Mask<width>& m, const Lanes& yes, const Lanes& no) { return m.v ? yes.v : no.v; }
  friend Lanes larger(const Lanes& a, const Lanes& b) { return a.v < b.v ? b.v : a.v; }
  friend Lanes smaller(const Lanes& a, const Lanes& b) { return b.v < a.v ? b.v : a.v; }
};

/// Square root of each lane; widths beyond the registers of the processor in parts.
template <int width>
inline Lanes<width> root(const Lanes<width>& a) {
  typename Lanes<width>::Vector r;
#if defined(__AVX512F__)
  if constexpr (width == 8) return Lanes<width>(_mm512_maskz_sqrt_pd(0xff, a.v));
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return Lanes<width>(_mm256_sqrt_pd(a.v));
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return Lanes<width>(_mm_sqrt_pd(a.v));
#endif
  for (int l = 0; l < width; ++l) r[l] = __builtin_sqrt(a.v[l]);
  return r;
}

/// One bit a lane.
template <int width>
inline unsigned bits(const Mask<width>& m) {
#if defined(__AVX512DQ__)
  if constexpr (width == 8) return unsigned(_mm512_movepi64_mask(__m512i(m.v)));
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return unsigned(_mm256_movemask_pd(__m256d(m.v)));
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return unsigned(_mm_movemask_pd(__m128d(m.v)));
#endif
  unsigned b = 0;
  for (int l = 0; l < width; ++l) b |= unsigned(m.v[l] & 1) << l;
  return b;
}
template <int width>
inline bool any(const Mask<width>& m) {
  return bits(m) != 0;
}

#if defined(__AVX__)
/// Four doubles in a row of memory.
struct Row {
  typedef double Vector __attribute__((vector_size(32)));
  Vector v;

  static Row load(const double* p) {
    Row r;
    std::memcpy(&r, p, sizeof r);
    return r;
  }
  /// x y z and 0.
  static Row load3(const double* p) { return {Vector(_mm256_maskload_pd(p, _mm256_setr_epi64x(-1, -1, -1, 0)))}; }
  void store(double* p) const { std::memcpy(p, this, sizeof *this); }
  void store3(double* p) const {
    _mm_storeu_pd(p, _mm256_castpd256_pd128(v));
    _mm_store_sd(p + 2, _mm256_extractf128_pd(v, 1));
  }
  static Row all(double x) { return {x - Vector{}}; }
  friend Row operator+(const Row& a, const Row& b) { return {a.v + b.v}; }
  friend Row operator-(const Row& a, const Row& b) { return {a.v - b.v}; }
  friend Row operator*(const Row& a, const Row& b) { return {a.v * b.v}; }
  /// The first three with the other sign.
  Row opposite() const { return {Vector(_mm256_xor_pd(v, _mm256_setr_pd(-0.0, -0.0, -0.0, 0.0)))}; }
};
#else
struct Row {
  typedef double Half __attribute__((vector_size(16)));
  Half lo, hi;

  static Row load(const double* p) {
    Row r;
    std::memcpy(&r.lo, p, sizeof r.lo);  // by halves, so that no compiler moves the row through memory
    std::memcpy(&r.hi, p + 2, sizeof r.hi);
    return r;
  }
  static Row load3(const double* p) {
    Row r;
    std::memcpy(&r.lo, p, sizeof r.lo);
    r.hi = Half{p[2], 0};
    return r;
  }
  void store(double* p) const {
    std::memcpy(p, &lo, sizeof lo);
    std::memcpy(p + 2, &hi, sizeof hi);
  }
  void store3(double* p) const {
    std::memcpy(p, &lo, sizeof lo);
    p[2] = hi[0];
  }
  static Row all(double x) { return {x - Half{}, x - Half{}}; }
  friend Row operator+(const Row& a, const Row& b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend Row operator-(const Row& a, const Row& b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend Row operator*(const Row& a, const Row& b) { return {a.lo * b.lo, a.hi * b.hi}; }
  Row opposite() const {
#if defined(__SSE2__)
    return {Half(_mm_xor_pd(lo, _mm_set1_pd(-0.0))), Half(_mm_xor_pd(hi, _mm_setr_pd(-0.0, 0.0)))};
#else
    return {-lo, Half{-hi[0], hi[1]}};
#endif
  }
};
#endif

/// Four lanes: the columns of as many rows as there are lanes.
template <int width>
struct Columns {
  Lanes<width> c[4];
};

#if defined(__AVX__)
inline void turn(const Row::Vector (&r)[4], Row::Vector (&c)[4]) {
  const __m256d a = _mm256_unpacklo_pd(r[0], r[1]), b = _mm256_unpackhi_pd(r[0], r[1]);
  const __m256d d = _mm256_unpacklo_pd(r[2], r[3]), e = _mm256_unpackhi_pd(r[2], r[3]);
  c[0] = _mm256_permute2f128_pd(a, d, 0x20);
  c[1] = _mm256_permute2f128_pd(b, e, 0x20);
  c[2] = _mm256_permute2f128_pd(a, d, 0x31);
  c[3] = _mm256_permute2f128_pd(b, e, 0x31);
}
#endif

template <int width>
inline Columns<width> columns(const Row (&rows)[width]) {
  Columns<width> out;
#if defined(__AVX__)
  Row::Vector c[width / 4][4];
  for (int part = 0; part < width / 4; ++part) {
    const Row* const r = rows + 4 * part;
    turn({r[0].v, r[1].v, r[2].v, r[3].v}, c[part]);
  }
  for (int k = 0; k < 4; ++k) {
    if constexpr (width == 4) out.c[k].v = c[0][k];
    if constexpr (width == 8) out.c[k].v = __builtin_shufflevector(c[0][k], c[1][k], 0, 1, 2, 3, 4, 5, 6, 7);
  }
#else
  static_assert(width == 2);
  out.c[0] = __builtin_shufflevector(rows[0].lo, rows[1].lo, 0, 2);
  out.c[1] = __builtin_shufflevector(rows[0].lo, rows[1].lo, 1, 3);
  out.c[2] = __builtin_shufflevector(rows[0].hi, rows[1].hi, 0, 2);
  out.c[3] = __builtin_shufflevector(rows[0].hi, rows[1].hi, 1, 3);
#endif
  return out;
}

template <int width>
inline void rows_of(const Columns<width>& in, Row (&rows)[width]) {
#if defined(__AVX__)
  for (int part = 0; part < width / 4; ++part) {
    Row::Vector c[4], r[4];
    for (int k = 0; k < 4; ++k) {
      if constexpr (width == 4) c[k] = in.c[k].v;
      if constexpr (width == 8)
        c[k] = part == 0 ? __builtin_shufflevector(in.c[k].v, in.c[k].v, 0, 1, 2, 3)
                         : __builtin_shufflevector(in.c[k].v, in.c[k].v, 4, 5, 6, 7);
    }
    turn(c, r);
    for (int k = 0; k < 4; ++k) rows[4 * part + k].v = r[k];
  }
#else
  rows[0].lo = __builtin_shufflevector(in.c[0].v, in.c[1].v, 0, 2);
  rows[1].lo = __builtin_shufflevector(in.c[0].v, in.c[1].v, 1, 3);
  rows[0].hi = __builtin_shufflevector(in.c[2].v, in.c[3].v, 0, 2);
  rows[1].hi = __builtin_shufflevector(in.c[2].v, in.c[3].v, 1, 3);
#endif
}

}  // namespace densify::dem::DENSIFY_ISA
