// Lanes of several doubles; rows.h has the turns between lanes and rows of memory.
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

  void store(double* p) const { std::memcpy(p, &v, sizeof v); }

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

}  // namespace densify::dem::DENSIFY_ISA
