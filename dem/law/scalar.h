#pragma once
// What a contact law needs of its numbers beside + - * / and comparison.  A law's hot functions are templates over the
// kind of number: a double here, lanes of several contacts in the contact kernels (dem/contact/lanes.h), which bring
// the same functions for theirs.  One source, one order of operations: both give the same bits.

#include <cmath>

namespace densify::dem {

inline double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
inline double root(double x) {
  return std::sqrt(x);
}
inline double smaller(double a, double b) {
  return b < a ? b : a;
}
inline double larger(double a, double b) {
  return a < b ? b : a;
}
inline bool any(bool condition) {
  return condition;
}

/// A vector of three numbers of a kind.
template <class T>
struct TripleOf {
  T x, y, z;

  friend TripleOf operator+(const TripleOf& a, const TripleOf& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend TripleOf operator-(const TripleOf& a, const TripleOf& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend TripleOf operator*(const T& s, const TripleOf& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class T>
T dot(const TripleOf<T>& a, const TripleOf<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
TripleOf<T> cross(const TripleOf<T>& a, const TripleOf<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Condition, class T>
TripleOf<T> select(const Condition& condition, const TripleOf<T>& yes, const TripleOf<T>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}

}  // namespace densify::dem
