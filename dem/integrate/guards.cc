#include "dem/integrate/guards.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "base/check.h"
#include "dem/simulation.h"

namespace densify::dem {

namespace {

// Numbers whose squares overflow are as good as infinite.
constexpr double largest_number = 1e150;
// A particle that moves by more than its own radius in a step can pass through another unseen.
constexpr double largest_motion = 1;
// Energy is known to a factor only: work is bounded from above, stored energy estimated.  An instability grows by
// orders of magnitude, so that a wide margin costs nothing but a few hundred steps.
constexpr double energy_margin = 10;

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

bool finite(const Vec3& v) {
  return std::abs(v[0]) < largest_number && std::abs(v[1]) < largest_number && std::abs(v[2]) < largest_number;
}

std::string name(const State& s, std::size_t p) {
  return "particle " + std::to_string(s.particles.id[p]);
}

struct DeepestContact {
  std::size_t pair = 0;
  double overlap = 0;  // over the smaller radius
};

double overlap_of(const State& s, std::size_t k) {
  const Body &a = s.particles.body[s.contacts.i(k)], &b = s.particles.body[s.contacts.j(k)];
  Vec3 branch = b.position - a.position;
  if (s.cell.periodic) branch += s.cell.shift(s.contacts.image(k));
  return (a.radius + b.radius - branch.norm()) / std::min(a.radius, b.radius);
}

/// " (deepest contact: with particle 7, overlap 0.21 of the smaller radius)", or that there is none.
std::string deepest_contact(const State& s, std::size_t p) {
  DeepestContact worst;
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    if (s.contacts.i(k) != p && s.contacts.j(k) != p) continue;
    const double overlap = overlap_of(s, k);
    if (overlap > worst.overlap) worst = {k, overlap};
  }
  if (worst.overlap <= 0) return " (it touches no other)";
  const std::size_t i = s.contacts.i(worst.pair), other = i == p ? s.contacts.j(worst.pair) : i;
  return " (its deepest contact is with " + name(s, other) + ", overlap " + number(worst.overlap) +
         " of the smaller radius)";
}

constexpr const char* smaller_step =
    "; the step is too large for the contacts: try a smaller step_safety, limit_interval "
    "or mass_scaling";

/// Times that add up to the same bits however a run is cut into pieces: multiples of a 2^40th of the process [s].
double countable(double time, double process) {
  const double quantum = std::exp2(std::floor(std::log2(process)) - 40);
  return std::round(time / quantum) * quantum;
}

}  // namespace

struct EnergySums {
  double elastic = 0;            // stored in springs [J]
  double reserve = 0;            // what the sintering forces could store in them [J]
  double supply_rate = 0;        // work of heat, flow of the cell, sintering and gravity, from above [W]
  double before = 0, after = 0;  // kinetic, of the particles, half a step before and after [J]
  double punch = 0;              // kinetic [J]
  double drive = 0;              // kinetic, that moving walls, heat and the flow of the cell impose, from above [J]
  double rounding = 0;           // that the rounding of positions and forces may bring in a step [J]
  double motion() const { return before + punch; }
};

namespace {

/// Adds the near pairs of one bucket; returns the place of the first pair that overlaps by more than `limit`.
template <class Law>
std::size_t add_bucket(const Law& law, const GuardView& view, std::size_t first, std::size_t last,
                       const ImageShifts& shifts, EnergySums& sums) {
  const State& s = view.state;
  const ContactList& list = s.contacts;
  const Body* const body = s.particles.body.data();
  const auto& model = view.setup.contact;
  const double limit = view.setup.integration.guards.largest_overlap;
  const bool flows = s.cell.periodic && !s.cell.velocity_gradient.isZero(0);
  const double flow = flows ? s.cell.velocity_gradient.norm() : 0.0;
  const double heat = view.growth_rate;
  for (std::size_t n = first; n < last; ++n) {
    const std::size_t k = view.near.places()[n];
    const Body &a = body[list.i(k)], &b = body[list.j(k)];
    Vec3 branch = b.position - a.position;
    if (s.cell.periodic) branch += shifts[list.image(k)];
    const double reach = a.radius + b.radius, d2 = branch.squaredNorm();
    bool necked = false;
    if constexpr (has_necks<Law>) necked = list.neck[k].phase != NeckPhase::loose;
    if (d2 >= reach * reach && !necked) continue;
    const double d = std::sqrt(d2), smaller = std::min(a.radius, b.radius);
    if (reach - d > limit * smaller) return k;
    double u = d - reach;
    const double radius = elastic_radius(model, a.radius, b.radius);
    const auto& spring = spring_of(law);
    bool springs = true;
    if constexpr (has_necks<Law>) {
      const NeckHistory& h = list.neck[k];
      if (necked) {
        u = h.elastic;
        springs = law.settings.model != SinteringModel::viscous || !Law::flows(h.phase);
        if (const double share = law.activity(h, s.time); share > 0) {
          const double f = law.sintering_force(h.radius, sintering_radius(law.settings.radius, a.radius, b.radius));
          sums.reserve += 0.5 * f * f / spring.tangent(u, radius);
          sums.supply_rate += f * std::abs((b.velocity - a.velocity).dot(branch)) / d;
        }
      }
    }
    if (springs) {
      sums.elastic += spring.energy(u, radius);
      if (heat > 0 || flow > 0) sums.supply_rate += std::abs(spring.force(u, radius)) * (heat * reach + flow * d);
    }
    if (!list.tangential.empty())
      sums.elastic += 0.5 * model.friction->tangential_stiffness_ratio * spring.tangent(u, radius) *
                      list.tangential[k].squaredNorm();
  }
  return list.size();
}

[[noreturn]] void refuse_deep_contact(const GuardView& view, std::size_t k) {
  const State& s = view.state;
  throw RunError("particles " + std::to_string(s.particles.id[s.contacts.i(k)]) + " and " +
                 std::to_string(s.particles.id[s.contacts.j(k)]) + " have gone too far into each other (overlap " +
                 number(overlap_of(s, k)) + " of the smaller radius, at most " +
                 number(view.setup.integration.guards.largest_overlap) +
                 "); the contacts are too soft for the load, or the step is too large");
}

void require_no_deep_contact(const GuardView& view) {
  const State& s = view.state;
  const ImageShifts shifts(s.cell);
  const Body* const body = s.particles.body.data();
  const double limit = view.setup.integration.guards.largest_overlap;
  for (const std::uint32_t k : view.near.places()) {
    const Body &a = body[s.contacts.i(k)], &b = body[s.contacts.j(k)];
    const double least = a.radius + b.radius - limit * std::min(a.radius, b.radius);
    const Vec3 branch = b.position - a.position + shifts[s.contacts.image(k)];
    if (least > 0 && branch.squaredNorm() < least * least) refuse_deep_contact(view, k);
  }
}

EnergySums add_contacts(const GuardView& view) {
  const State& s = view.state;
  const ImageShifts shifts(s.cell);
  const auto& model = view.setup.contact;
  const auto& ends = view.near.bucket_end();
  EnergySums sums;
  if (view.near.empty()) return sums;  // before the first pass
  for (std::size_t b = 0; b < s.contacts.buckets.size(); ++b) {
    const auto& bucket = s.contacts.buckets[b];
    const PairProperties& row = view.table.row(bucket.material_a, bucket.material_b);
    std::size_t deep = s.contacts.size();
    with_law(model, row, !s.contacts.neck.empty(),
             [&](const auto& law) { deep = add_bucket(law, view, b == 0 ? 0 : ends[b - 1], ends[b], shifts, sums); });
    if (deep != s.contacts.size()) refuse_deep_contact(view, deep);
  }
  return sums;
}

double speed_of(const Wall& wall) {
  return wall.velocity.norm() + std::abs(wall.radius_rate) +
         std::abs(wall.thermal_rate) * (wall.point.norm() + wall.radius);
}

void add_motion(const GuardView& view, EnergySums& sums) {
  const State& s = view.state;
  const Particles& p = s.particles;
  const double g = view.setup.integration.gravity.norm();
  const double frequency = s.critical_step > 0 ? 2 / s.critical_step : 0.0;  // largest [1/s]
  double fastest_wall = 0;
  for (const Wall& wall : s.walls.wall)
    if (s.punch.mass == 0 || wall.name != "punch") fastest_wall = std::max(fastest_wall, speed_of(wall));
  const double strain_rate = view.growth_rate + (s.cell.periodic ? s.cell.velocity_gradient.norm() : 0.0);
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Body& b = p.body[q];
    const double mass = 1 / b.inverse_mass;
    if (strain_rate > 0 || fastest_wall > 0) {  // what is set in motion at once swings up to twice as fast
      const double v = 2 * (fastest_wall + strain_rate * ((b.position - p.body[0].position).norm() + b.radius));
      sums.drive += 0.5 * mass * v * v;
    }
    const double last_digit = std::numeric_limits<double>::epsilon() * (b.position.norm() + b.radius);
    sums.rounding += (p.force[q].norm() + mass * frequency * frequency * last_digit) * last_digit;
    sums.before += 0.5 * mass * b.velocity.squaredNorm();
    sums.after += 0.5 * mass * (b.velocity + b.inverse_mass * s.last_step * p.force[q]).squaredNorm();
    if (g > 0) sums.supply_rate += mass / view.setup.integration.mass_scaling * g * b.velocity.norm();
    if (!p.torque.empty()) {
      const double inertia = 0.4 * mass * b.radius * b.radius;
      sums.before += 0.5 * inertia * p.angular_velocity[q].squaredNorm();
      sums.after += 0.5 * inertia * (p.angular_velocity[q] + s.last_step / inertia * p.torque[q]).squaredNorm();
    }
  }
  sums.punch = 0.5 * s.punch.mass * s.punch.velocity * s.punch.velocity;
}

/// Masses that follow from a step or are left out carry no balance of energy from step to step.
bool masses_stand(const GuardView& view) {
  return view.setup.integration.inertia == Inertia::uniform && !view.state.inertia_free;
}

/// The particle with the largest kinetic energy.
std::size_t fastest(const Particles& p) {
  std::size_t worst = 0;
  double largest = -1;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const double k = p.body[q].velocity.squaredNorm() / p.body[q].inverse_mass;
    if (k > largest) worst = q, largest = k;
  }
  return worst;
}

}  // namespace

void require_finite(const State& s) {
  const Particles& p = s.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Body& b = p.body[q];
    const char* what = !finite(b.position)                                   ? "position"
                       : !finite(b.velocity)                                 ? "velocity"
                       : !finite(p.force[q])                                 ? "force"
                       : !(b.radius > 0 && b.radius < largest_number)        ? "radius"
                       : !p.torque.empty() && !finite(p.angular_velocity[q]) ? "spin"
                       : !p.torque.empty() && !finite(p.torque[q])           ? "torque"
                                                                             : nullptr;
    if (!what) continue;
    throw RunError("the " + std::string(what) + " of particle " + std::to_string(p.id[q]) + " is no longer finite" +
                   deepest_contact(s, q) + smaller_step);
  }
  if (s.punch.mass > 0 && !(std::abs(s.punch.velocity) < largest_number))
    throw RunError(std::string("the velocity of the punch is no longer finite") + smaller_step);
}

void Guards::look(const GuardView& view) {
  if (view.setup.integration.guards.guarding == Guarding::off) return;
  const std::uint64_t steps = view.state.steps;
  // A run may have few steps, and without inertia each of them is long.
  const bool always = view.state.inertia_free || (steps < contact_interval && std::has_single_bit(steps));
  if (!always && steps % particle_interval != 0) return;
  look_at_particles(view);
  if (always || steps % contact_interval == 0) look_at_contacts(view);
}

void Guards::forget() {
  *this = Guards();
}

void Guards::require_sound(const GuardView& view) const {
  if (view.setup.integration.guards.guarding == Guarding::off) return require_finite(view.state);
  look_at_particles(view);
  require_no_deep_contact(view);
}

void Guards::look_at_particles(const GuardView& view) const {
  const State& s = view.state;
  const Particles& p = s.particles;
  const double step2 = s.last_step * s.last_step;
  double sum = 0, furthest = 0;  // the sum is not finite when anything in it is not
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Body& b = p.body[q];
    const double v2 = b.velocity.squaredNorm();
    sum += b.position.squaredNorm() + v2 + p.force[q].squaredNorm() + b.radius;
    furthest = std::max(furthest, v2 * step2 / (b.radius * b.radius));
  }
  for (std::size_t q = 0; q < p.torque.size(); ++q)
    sum += p.angular_velocity[q].squaredNorm() + p.torque[q].squaredNorm();
  sum += s.punch.velocity * s.punch.velocity;
  if (!(sum < std::numeric_limits<double>::infinity())) require_finite(s);
  if (furthest > largest_motion * largest_motion) {
    std::size_t worst = 0;
    double share = 0;
    for (std::size_t q = 0; q < p.size(); ++q) {
      const double own = p.body[q].velocity.norm() * s.last_step / p.body[q].radius;
      if (own > share) worst = q, share = own;
    }
    throw RunError(name(s, worst) + " moves by " + number(share) + " of its radius in one step" +
                   deepest_contact(s, worst) + smaller_step);
  }
  s.walls.require_inside(p);
}

/// Ends the run when there is more kinetic energy than work can have brought.
void Guards::require_balance(const GuardView& view, const EnergySums& sums) {
  const State& s = view.state;
  const double interval = looked_ ? s.time - time_ : 0.0;
  // Work since the last look, from above: rates by the larger of both ends; forces that are given by the way between
  // them, or by the present velocity when that says more, for what swings takes and gives many times.
  double rate = sums.supply_rate, work = 0;
  for (std::size_t w = 0; w < s.walls.wall.size(); ++w) {
    const Wall& wall = s.walls.wall[w];
    rate += std::abs(s.walls.normal_force()[w]) * speed_of(wall);
    if (s.punch.mass > 0 && wall.name == "punch") {
      const double way = std::max(std::abs(wall.point[2] - punch_position_), std::abs(s.punch.velocity) * interval);
      if (looked_) work += std::max(view.pressure, pressure_) * s.punch.area * way;
      punch_position_ = wall.point[2];
    }
  }
  const auto& loads = view.setup.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const Body& b = s.particles.body[loads[l].particle];
    if (looked_)
      work += loads[l].force.norm() * std::max((b.position - loaded_[l]).norm(), b.velocity.norm() * interval);
  }
  loaded_.clear();
  for (const auto& load : loads) loaded_.push_back(s.particles.body[load.particle].position);
  work += std::max(rate, supply_rate_) * interval;
  supply_rate_ = rate;
  drive_ = sums.drive;
  pressure_ = view.pressure;

  const double now = sums.elastic + sums.punch + std::max(sums.before, sums.after);
  // Motion that is imposed at once has its energy whatever the forces at the two looks; where there is next to no
  // energy, rounding does work of its own.
  work += std::max(sums.drive, drive_) +
          (sums.rounding + std::numeric_limits<double>::epsilon() * now) * double(s.steps - steps_);
  steps_ = s.steps;
  budget_ = looked_ ? std::min(budget_ + work, now) : now;
  // A free vibration at a step near the limit shows up to 1/(1 - (dt/dt_c)^2) of its least energy as kinetic.
  const double nearness = s.critical_step > 0 ? std::min(0.99, s.last_step / s.critical_step) : 0.0;
  const double margin = std::max(energy_margin, 2 / (1 - nearness * nearness));
  if (sums.motion() > margin * (budget_ + sums.reserve)) {
    const std::size_t p = fastest(s.particles);
    throw RunError("kinetic energy has grown to " + number(sums.motion()) + " J and at most " +
                   number(budget_ + sums.reserve) + " J can be there; most of it is in " + name(s, p) +
                   deepest_contact(s, p) + smaller_step);
  }
}

void Guards::look_at_contacts(const GuardView& view) {
  const State& s = view.state;
  EnergySums sums = add_contacts(view);
  add_motion(view, sums);
  sums.elastic += s.walls.elastic_energy(s.particles, view.table, view.setup.contact);
  if (masses_stand(view)) require_balance(view, sums);

  const bool flowing = s.cell.periodic && !s.cell.velocity_gradient.isZero(0);
  const bool driven =
      flowing || !view.setup.loads.empty() || sums.reserve > 0 || (view.pressure > 0 && s.punch.mass > 0);
  if (!std::isnan(time_) && driven) {
    const double springs = sums.elastic + sums.reserve;
    if (sums.motion() > view.setup.integration.guards.quasi_static_ratio * springs)
      not_quasi_static_ += countable(s.time - time_, view.setup.schedule.end());
    if (springs > 0 && sums.motion() / springs > largest_ratio_)
      largest_ratio_ = sums.motion() / springs, time_of_largest_ratio_ = s.time;
  }
  looked_ = true;
  time_ = s.time;
}

}  // namespace densify::dem
