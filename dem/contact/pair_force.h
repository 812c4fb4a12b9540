#pragma once
// One pair of particles at one step: geometry, normal law, friction.  Templates over the kind of number, as the laws
// are: the same operations in the same order for one contact and for lanes of several.

#include "dem/law/coulomb.h"
#include "dem/law/sintering.h"

namespace densify::dem {

/// True for the laws whose contacts carry a neck.
template <class Law>
inline constexpr bool has_necks =
    !std::is_same_v<Law, KelvinVoigt<LinearSpring>> && !std::is_same_v<Law, KelvinVoigt<HertzSpring>>;

/// True for the laws that ask for each radius and not for their sum alone.
template <class Law>
inline constexpr bool needs_radii = !std::is_same_v<Law, KelvinVoigt<LinearSpring>>;

/// The law's normal spring.
template <class Law>
[[gnu::always_inline]] inline const auto& spring_of(const Law& law) {
  if constexpr (has_necks<Law>)
    return law.loose.spring;
  else
    return law.spring;
}

/// What is the same for all pairs of a bucket.
struct PairUniform {
  Friction friction;
  bool equivalent_radius;  ///< Hertz with 2 r_i r_j/(r_i + r_j)
  double step, time;       ///< [s]
};

/// A pair as a pass finds it.
template <class T>
struct PairOf {
  TripleOf<T> branch;    ///< x_j - x_i [m]
  TripleOf<T> velocity;  ///< v_j - v_i, with the flow of a deforming cell [m/s]
  T reach;               ///< r_i + r_j [m]
  T inverse_masses;      ///< 1/m_i + 1/m_j [1/kg]
  T radius_i, radius_j;  ///< only where law or friction needs them or heat makes particles grow [m]
};

/// Adds the flow L x of a cell with the velocity gradient L, by columns, to the velocity between the two.
template <class T>
void add_flow(PairOf<T>& pair, const double* l) {
  const TripleOf<T>& x = pair.branch;
  pair.velocity.x = pair.velocity.x + (l[0] * x.x + l[3] * x.y + l[6] * x.z);
  pair.velocity.y = pair.velocity.y + (l[1] * x.x + l[4] * x.y + l[7] * x.z);
  pair.velocity.z = pair.velocity.z + (l[2] * x.x + l[5] * x.y + l[8] * x.z);
}

/// Geometry of a pair and the input of its normal law.
template <class T>
struct FrameOf {
  TripleOf<T> normal;
  T approach;  ///< (v_j - v_i) n [m/s]
  NormalInputOf<T> in;
};

/// `d2` is the square of the branch.  One division serves all inverses, and it does not wait for the root.
template <class Law, class T>
FrameOf<T> frame_of(const Law& law, const PairUniform& uniform, const PairOf<T>& pair, const T& d2) {
  FrameOf<T> f;
  NormalInputOf<T>& in = f.in;
  const T d = root(d2);
  T inverse_d2;
  if constexpr (needs_radii<Law>) {
    const T both = pair.inverse_masses * pair.reach, inverse = 1.0 / (both * d2);
    inverse_d2 = inverse * both;
    in.reduced_mass = inverse * (pair.reach * d2);
    const T product = pair.radius_i * pair.radius_j * (inverse * (pair.inverse_masses * d2));
    in.elastic_radius = uniform.equivalent_radius ? 2 * product : product;
    if constexpr (has_necks<Law>)
      in.sintering_radius =
          law.settings.radius == SinteringRadius::smaller ? smaller(pair.radius_i, pair.radius_j) : 2 * product;
    else
      in.sintering_radius = 0.0;
  } else {
    const T inverse = 1.0 / (pair.inverse_masses * d2);
    inverse_d2 = inverse * pair.inverse_masses;
    in.reduced_mass = inverse * d2;
    in.elastic_radius = in.sintering_radius = 0.0;
  }
  const T inverse_distance = d * inverse_d2;
  f.normal = inverse_distance * pair.branch;
  f.approach = dot(pair.velocity, f.normal);
  in.overlap = d - pair.reach;
  in.rate = f.approach;
  in.step = uniform.step;
  in.time = uniform.time;
  return f;
}

/// What heat adds to the distance at which a pair is at rest [m], from relative growths, or its rate from theirs. Loose
/// spheres meet at their surfaces; through a neck the body is whole, so that only the way from each centre to the
/// neck's plane grows and a bonded packing expands as one body, however unequal its overlaps.
template <class T, class Condition>
T thermal_growth(const T& radius_i, const T& radius_j, const T& overlap, const T& of_i, const T& of_j,
                 const Condition& necked) {
  const T cut = select(necked, 0.5 * overlap, T(0.0));
  return of_i * (radius_i + cut) + of_j * (radius_j + cut);
}

/// Friction of a contact: force on i and couple n x F_t, which times the lever of i or j is the torque on i or j.
template <class T>
struct FrictionOf {
  TripleOf<T> force, couple;
};

/// `levers` from each centre to the contact point, `spin` = lever_i w_i + lever_j w_j, `share` of the Coulomb friction
/// that is left; without any the spring `slip` is at rest.
template <class Law, class T>
FrictionOf<T> friction_of(const Law& law, const PairUniform& uniform, const PairOf<T>& pair, const FrameOf<T>& frame,
                          const NormalForceOf<T>& normal, const TripleOf<T>& spin, const T& share, TripleOf<T>& slip) {
  const TripleOf<T>& n = frame.normal;
  const TangentialInputOf<T> in{n,
                                pair.velocity - frame.approach * n - cross(spin, n),
                                share * larger(T(0.0), normal.sintering - normal.total),
                                spring_of(law).tangent(frame.in.overlap, frame.in.elastic_radius),
                                frame.in.reduced_mass,
                                uniform.step};
  FrictionOf<T> f;
  f.force = coulomb(uniform.friction, in, slip);
  f.couple = cross(n, f.force);
  const auto left = share > 0;
  const TripleOf<T> none{0.0, 0.0, 0.0};
  f.force = select(left, f.force, none);
  f.couple = select(left, f.couple, none);
  slip = select(left, slip, none);
  return f;
}

/// What a record keeps of a normal spring, and no force needs.
template <class T>
struct SpringRecordOf {
  T damping;  ///< the damper's part of the normal force [N]
  T energy;   ///< [J]
};

/// `u` is the spring's displacement after the step; `springs`: whether there is one.
template <class Law, class T, class Condition>
SpringRecordOf<T> spring_record(const Law& law, const FrameOf<T>& frame, const NormalForceOf<T>& normal, const T& u,
                                const Condition& springs) {
  const auto& spring = spring_of(law);
  const T none = 0.0, radius = frame.in.elastic_radius;
  return {select(springs, normal.total - normal.sintering - spring.force(u, radius), none),
          select(springs, spring.energy(u, radius), none)};
}

/// What a pair adds to the StiffnessSum of both its particles: xx yy zz xy, xz yz force.
template <class T>
struct StiffnessOf {
  T xx, yy, zz, xy, xz, yz, force;
};

template <bool friction, class Law, class T>
StiffnessOf<T> stiffness_of(const Law& law, const PairUniform& uniform, const FrameOf<T>& frame,
                            const NormalForceOf<T>& normal, const T& along, double next_step) {
  T across = 0.0;
  if constexpr (friction)
    across =
        tangential_step_stiffness(uniform.friction, spring_of(law).tangent(frame.in.overlap, frame.in.elastic_radius),
                                  frame.in.reduced_mass, next_step);
  const TripleOf<T>& n = frame.normal;
  const TripleOf<T> m = (along - across) * n;
  return {across + m.x * n.x,
          across + m.y * n.y,
          across + m.z * n.z,
          m.x * n.y,
          m.x * n.z,
          m.y * n.z,
          larger(larger(normal.total, -normal.total), normal.sintering)};
}

}  // namespace densify::dem
