// Rows of four or eight doubles in memory, and the turn between rows and lanes.  For contact/kernel.cc only, as
// lanes.h.
#pragma once

#include "dem/contact/lanes.h"

namespace densify::dem::DENSIFY_ISA {

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
#if defined(__AVX512F__)
  if constexpr (width == 8) {
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                  high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    __m512d two[4];  // rows k and k + 4
    for (int k = 0; k < 4; ++k) two[k] = _mm512_insertf64x4(_mm512_castpd256_pd512(rows[k].v), rows[k + 4].v, 1);
    const __m512d a = _mm512_unpacklo_pd(two[0], two[1]), b = _mm512_unpackhi_pd(two[0], two[1]);
    const __m512d d = _mm512_unpacklo_pd(two[2], two[3]), e = _mm512_unpackhi_pd(two[2], two[3]);
    out.c[0] = {_mm512_permutex2var_pd(a, low, d)};
    out.c[1] = {_mm512_permutex2var_pd(b, low, e)};
    out.c[2] = {_mm512_permutex2var_pd(a, high, d)};
    out.c[3] = {_mm512_permutex2var_pd(b, high, e)};
    return out;
  }
#endif
#if defined(__AVX__)
  if constexpr (width == 4) {
    Row::Vector c[4];
    turn({rows[0].v, rows[1].v, rows[2].v, rows[3].v}, c);
    for (int k = 0; k < 4; ++k) out.c[k].v = c[k];
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
#if defined(__AVX512F__)
  if constexpr (width == 8) {
    const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11),
                  last = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    const __m512d a = _mm512_unpacklo_pd(in.c[0].v, in.c[1].v), b = _mm512_unpackhi_pd(in.c[0].v, in.c[1].v);
    const __m512d d = _mm512_unpacklo_pd(in.c[2].v, in.c[3].v), e = _mm512_unpackhi_pd(in.c[2].v, in.c[3].v);
    const __m512d two[4] = {_mm512_permutex2var_pd(a, first, d), _mm512_permutex2var_pd(b, first, e),
                            _mm512_permutex2var_pd(a, last, d), _mm512_permutex2var_pd(b, last, e)};
    for (int k = 0; k < 4; ++k) {
      const int l = k < 2 ? k : k + 2;
      rows[l] = {_mm512_castpd512_pd256(two[k])};
      rows[l + 2] = {_mm512_extractf64x4_pd(two[k], 1)};
    }
    return;
  }
#endif
#if defined(__AVX__)
  if constexpr (width == 4) {
    Row::Vector r[4];
    turn({in.c[0].v, in.c[1].v, in.c[2].v, in.c[3].v}, r);
    for (int k = 0; k < 4; ++k) rows[k].v = r[k];
  }
#else
  rows[0].lo = __builtin_shufflevector(in.c[0].v, in.c[1].v, 0, 2);
  rows[1].lo = __builtin_shufflevector(in.c[0].v, in.c[1].v, 1, 3);
  rows[0].hi = __builtin_shufflevector(in.c[2].v, in.c[3].v, 0, 2);
  rows[1].hi = __builtin_shufflevector(in.c[2].v, in.c[3].v, 1, 3);
#endif
}

#if defined(__AVX512F__)
/// Eight doubles in a row of memory.
struct Record {
  __m512d v;

  /// b - a, but the fourth and the eighth b + a; `shift` (four doubles) is added to the first four.
  static Record between(const double* a, const double* b, const double* shift) {
    const __m512d sign = _mm512_setr_pd(-0.0, -0.0, -0.0, 0.0, -0.0, -0.0, -0.0, 0.0);
    const __m512d d = _mm512_add_pd(_mm512_loadu_pd(b), _mm512_xor_pd(_mm512_loadu_pd(a), sign));
    return {_mm512_mask_add_pd(d, 0x0f, d, _mm512_zextpd256_pd512(_mm256_loadu_pd(shift)))};
  }
  static Record load(const double* p) { return {_mm512_loadu_pd(p)}; }
  void store(double* p) const { _mm512_storeu_pd(p, v); }
  friend Record operator+(const Record& a, const Record& b) { return {_mm512_add_pd(a.v, b.v)}; }
  /// The last four times a number.
  Record last_times(double x) const { return {_mm512_mask_mul_pd(v, 0xf0, v, _mm512_set1_pd(x))}; }
  /// The first four with the other sign, the last four times a number.
  Record opposite_last_times(double x) const {
    return {_mm512_mul_pd(v, _mm512_mask_blend_pd(0xf0, _mm512_set1_pd(-1.0), _mm512_set1_pd(x)))};
  }
};

inline void turn(const __m512d (&r)[8], __m512d (&c)[8]) {
  __m512d t[8], u[8];
  for (int k = 0; k < 8; k += 2) {
    t[k] = _mm512_unpacklo_pd(r[k], r[k + 1]);
    t[k + 1] = _mm512_unpackhi_pd(r[k], r[k + 1]);
  }
  for (int odd = 0; odd < 2; ++odd)
    for (int half = 0; half < 2; ++half) {
      u[4 * odd + 2 * half] = _mm512_shuffle_f64x2(t[4 * half + odd], t[4 * half + 2 + odd], 0x88);
      u[4 * odd + 2 * half + 1] = _mm512_shuffle_f64x2(t[4 * half + odd], t[4 * half + 2 + odd], 0xdd);
    }
  for (int odd = 0; odd < 2; ++odd) {
    const __m512d* const w = u + 4 * odd;
    c[0 + odd] = _mm512_shuffle_f64x2(w[0], w[2], 0x88);
    c[4 + odd] = _mm512_shuffle_f64x2(w[0], w[2], 0xdd);
    c[2 + odd] = _mm512_shuffle_f64x2(w[1], w[3], 0x88);
    c[6 + odd] = _mm512_shuffle_f64x2(w[1], w[3], 0xdd);
  }
}

inline void columns(const Record (&r)[8], Columns<8>& first, Columns<8>& last) {
  __m512d c[8];
  turn({r[0].v, r[1].v, r[2].v, r[3].v, r[4].v, r[5].v, r[6].v, r[7].v}, c);
  for (int k = 0; k < 4; ++k) first.c[k] = {c[k]}, last.c[k] = {c[4 + k]};
}

inline void columns(const Record (&r)[4], Columns<4>& first, Columns<4>& last) {
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  const __m512d a = _mm512_unpacklo_pd(r[0].v, r[1].v), b = _mm512_unpackhi_pd(r[0].v, r[1].v);
  const __m512d d = _mm512_unpacklo_pd(r[2].v, r[3].v), e = _mm512_unpackhi_pd(r[2].v, r[3].v);
  const __m512d c[4] = {_mm512_permutex2var_pd(a, low, d), _mm512_permutex2var_pd(b, low, e),
                        _mm512_permutex2var_pd(a, high, d), _mm512_permutex2var_pd(b, high, e)};
  for (int k = 0; k < 4; ++k) {
    first.c[k] = {_mm512_castpd512_pd256(c[k])};
    last.c[k] = {_mm512_extractf64x4_pd(c[k], 1)};
  }
}
/// Turns columns into records.
inline void records_of(const Columns<8>& first, const Columns<8>& last, Record (&records)[8]) {
  __m512d r[8];
  turn({first.c[0].v, first.c[1].v, first.c[2].v, first.c[3].v, last.c[0].v, last.c[1].v, last.c[2].v, last.c[3].v}, r);
  for (int l = 0; l < 8; ++l) records[l] = {r[l]};
}

inline void records_of(const Columns<4>& first, const Columns<4>& last, Record (&records)[4]) {
  Row a[4], b[4];
  rows_of<4>(first, a);
  rows_of<4>(last, b);
  for (int l = 0; l < 4; ++l) records[l] = {_mm512_insertf64x4(_mm512_castpd256_pd512(a[l].v), b[l].v, 1)};
}
#else
struct Record {
  Row first, last;

  static Record between(const double* a, const double* b, const double* shift) {
    return {Row::load(b) + Row::load(a).opposite() + Row::load(shift), Row::load(b + 4) + Row::load(a + 4).opposite()};
  }
  static Record load(const double* p) { return {Row::load(p), Row::load(p + 4)}; }
  void store(double* p) const {
    first.store(p);
    last.store(p + 4);
  }
  friend Record operator+(const Record& a, const Record& b) { return {a.first + b.first, a.last + b.last}; }
  Record last_times(double x) const { return {first, last * Row::all(x)}; }
  Record opposite_last_times(double x) const { return {first.opposite(), last * Row::all(x)}; }
};

template <int width>
inline void columns(const Record (&r)[width], Columns<width>& first, Columns<width>& last) {
  Row rows[width];
  for (int l = 0; l < width; ++l) rows[l] = r[l].first;
  first = columns<width>(rows);
  for (int l = 0; l < width; ++l) rows[l] = r[l].last;
  last = columns<width>(rows);
}

template <int width>
inline void records_of(const Columns<width>& first, const Columns<width>& last, Record (&records)[width]) {
  Row rows[width];
  rows_of<width>(first, rows);
  for (int l = 0; l < width; ++l) records[l].first = rows[l];
  rows_of<width>(last, rows);
  for (int l = 0; l < width; ++l) records[l].last = rows[l];
}
#endif

}  // namespace densify::dem::DENSIFY_ISA
