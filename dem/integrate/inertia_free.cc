#include "dem/integrate/inertia_free.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "dem/network/network.h"
#include "dem/simulation.h"

namespace densify::dem {

namespace {

using Vector = Eigen::VectorXd;
using End = NetworkLink::End;

constexpr int most_newton = 10;          // solutions of one trial
constexpr double young_neck = 0.15;      // neck over radius below which a neck resists at least as one of this size
constexpr double shortest_share = 1e-6;  // of the first trial, before a step counts as impossible

/// A contact over a trial step.
struct StepContact {
  NormalInput now;        // at the present positions
  double step, end;       // [s], process time
  double growth;          // thermal, of r_i + r_j [m]
  double growth_in_rate;  // thermal, as the law's rate counts it [m]
};

/// Force at the end of the step when the ends part at `rate` [m/s]: what the force pass will find there.
template <class Law>
double force_at_end(const Law& law, const NeckHistory* neck, const StepContact& c, double rate) {
  NormalInput in = c.now;
  in.overlap += c.step * rate - c.growth;
  in.rate = rate - c.growth_in_rate / c.step;
  in.step = c.step;
  in.time = c.end;
  if constexpr (has_necks<Law>) {
    NeckHistory after = *neck;
    if (after.phase == NeckPhase::loose && in.overlap >= 0) return 0;
    return law.update(in, after).total;
  } else {
    return in.overlap >= 0 ? 0.0 : law.update(in).total;
  }
}

/// dF/d(rate) by a difference towards approach.  A neck resists at least as one of 0.15 of its radius does, since its
/// own viscosity, which grows as a^4, would let it shoot over in the first steps of its life.
template <class Law>
double coefficient(const Law& law, const NeckHistory* neck, const StepContact& c, double rate, double force) {
  constexpr double share = 1e-4, smallest = 1e-7;
  const double radius = 0.5 * (c.now.elastic_radius + std::max(c.now.elastic_radius, c.now.sintering_radius));
  const double change = std::max(share * std::abs(rate), smallest * radius / c.step);
  double slope = std::max(0.0, (force - force_at_end(law, neck, c, rate - change)) / change);
  if constexpr (has_necks<Law>)
    if (Law::flows(neck->phase)) {
      const double eta = law.viscosity(young_neck * c.now.sintering_radius);
      const double k = law.loose.spring.tangent(neck->elastic, c.now.elastic_radius);
      const double least = law.settings.model == SinteringModel::viscous ? eta : k * c.step / (1 + k * c.step / eta);
      slope = std::max(slope, least);
    }
  return slope;
}

}  // namespace

/// One attempt at a step.
struct InertiaFree::Trial {
  double step, end;         // [s], process time at its end
  double wall_stretch = 1;  // of the lateral walls by heat over the step
  double load = 0;          // p A on the guided wall [N]
  std::optional<std::size_t> guided;
};

InertiaFree::Trial InertiaFree::prepare(const State& s, const Setup& setup, const PairTable& table,
                                        std::optional<std::size_t> guided, double step) {
  Trial t{step, s.time + step, 1, 0, guided};
  const double breakpoint = setup.schedule.next_breakpoint(s.time);
  if (t.end >= breakpoint) t.end = breakpoint;
  const double temperature = setup.schedule.temperature(t.end);
  const double hot = temperature - setup.reference_temperature, warm = s.temperature - setup.reference_temperature;
  table_ = table;
  table_->update(temperature, t.end);
  growth_.resize(setup.materials.size());
  for (std::size_t m = 0; m < growth_.size(); ++m)
    growth_[m] = (1 + setup.materials[m].thermal_expansion * hot) / s.expansion[m] - 1;
  const double a = setup.container.wall_expansion;
  t.wall_stretch = (1 + a * hot) / (1 + a * warm);
  t.load = guided ? setup.schedule.pressure(t.end) * s.punch.area * t.wall_stretch * t.wall_stretch : 0.0;
  external_.setZero(network_.rows());
  for (const auto& load : setup.loads)
    external_.segment<3>(3 * load.particle) += (load.ramp > 0 ? std::min(1.0, t.end / load.ramp) : 1.0) * load.force;
  if (!setup.integration.gravity.isZero(0))
    for (std::size_t p = 0; p < s.particles.size(); ++p)
      external_.segment<3>(Eigen::Index(3 * p)) += setup.integration.gravity / s.particles.body[p].inverse_mass;
  if (guided) external_[network_.rows() - 1] = -t.load;
  return t;
}

void InertiaFree::respond(const State& s, const Setup& setup, const Trial& t) {
  network_.clear();
  resultant_ = external_;
  double squares = external_.squaredNorm();
  const bool deforming = s.cell.periodic && !s.cell.velocity_gradient.isZero(0);
  const double lateral_share = setup.integration.inertia_free.tangential_share;
  const ContactWorld world{s.particles, s.contacts, s.cell, *table_, setup.contact, s.walls};
  visit_contacts(world, s.contacts.skin, [&](const ContactView& view, const auto& law, const NeckHistory* neck) {
    NetworkLink link{view.normal, 0, 0, view.i, view.j, End::particle};
    StepContact c{view.input, t.step, t.end, 0, 0};
    const Body& a = s.particles.body[view.i];
    const double grown_i = growth_[s.particles.material[view.i]];
    Vec3 motion;
    if (view.at_wall) {
      const Wall& wall = s.walls.wall[view.j];
      link.end = t.guided && view.j == *t.guided ? End::guided_wall : End::fixed_wall;
      motion = network_.relative(link, velocity_);
      c.growth = c.growth_in_rate = grown_i * a.radius;
      if (wall.shape == WallShape::cylinder) {
        motion += wall.radius_rate * view.normal;
        c.growth -= (t.wall_stretch - 1) * wall.radius;
      } else {
        if (link.end == End::fixed_wall) motion += wall.velocity;
        constexpr double lateral = 0.5;
        if (std::abs(wall.normal[2]) < lateral) c.growth += (t.wall_stretch - 1) * wall.point.dot(wall.normal);
      }
    } else {
      const Body& b = s.particles.body[view.j];
      const double grown_j = growth_[s.particles.material[view.j]];
      motion = network_.relative(link, velocity_);
      if (deforming) motion += s.cell.velocity_gradient * view.branch;
      c.growth = c.growth_in_rate = grown_i * a.radius + grown_j * b.radius;
      if (neck && neck->phase != NeckPhase::loose)  // through a neck only the way to its plane grows
        c.growth_in_rate += 0.5 * view.input.overlap * (grown_i + grown_j);
    }
    const bool loose = !neck || neck->phase == NeckPhase::loose;
    const double rate = motion.dot(view.normal);
    if (loose && view.input.overlap >= 0 && view.input.overlap + t.step * rate - c.growth >= 0) return;
    const double force = force_at_end(law, neck, c, rate);
    link.coefficient = coefficient(law, neck, c, rate, force);
    link.lateral = lateral_share * link.coefficient;
    network_.add_force(link, force * view.normal + link.lateral * (motion - rate * view.normal), resultant_);
    network_.add(link);
    squares += force * force;
  });
  force_scale_ = std::sqrt(squares);
}

bool InertiaFree::balance(const State& s, const Setup& setup, const Trial& t) {
  const double goal = setup.integration.inertia_free.force_tolerance;
  for (int n = 0;; ++n) {
    respond(s, setup, t);
    const double residual = resultant_.norm();
    if (!std::isfinite(residual)) return false;
    if (residual <= goal * force_scale_) return true;
    if (n == most_newton) return false;
    constexpr double forcing = 0.1, within_goal = 0.3;
    change_.setZero(network_.rows());
    const SolverReport report =
        network_.solve(resultant_, change_, {std::max(forcing * residual, within_goal * goal * force_scale_), 0});
    ++count_.solutions;
    count_.iterations += std::uint64_t(report.iterations);
    velocity_ += change_;
  }
}

double InertiaFree::error_estimate(const State& s, const Trial& t, const Vector& before) const {
  double radius = 0, sum = 0;
  for (const double r : s.particles.reference_radius) radius += r / double(s.particles.size());
  const Vector difference = velocity_ - before;
  for (const NetworkLink& link : network_.links())
    sum += std::abs(network_.relative(link, difference).dot(link.normal));
  const double count = std::max<double>(1, double(network_.links().size()));
  return 0.5 * t.step * sum / count / radius;
}

void InertiaFree::apply(State& s, const Trial& t) const {
  const bool deforming = s.cell.periodic && !s.cell.velocity_gradient.isZero(0);
  const Mat3 flow = t.step * s.cell.velocity_gradient;
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    Body& b = s.particles.body[p];
    b.velocity = velocity_.segment<3>(Eigen::Index(3 * p));
    if (deforming) b.position += flow * (b.position - s.cell.origin);
    b.position += t.step * b.velocity;
  }
  if (deforming) s.cell.h += flow * s.cell.h;
  if (t.guided) {
    s.punch.velocity = s.punch.mean_velocity = velocity_[network_.rows() - 1];
    s.punch.mean_acceleration = 0;
    s.walls.wall[*t.guided].velocity = Vec3(0, 0, s.punch.velocity);
  }
  for (auto& w : s.walls.wall) {
    w.point += t.step * w.velocity;
    w.radius += t.step * w.radius_rate;
  }
}

double InertiaFree::move(State& s, const Setup& setup, const PairTable& table, std::optional<std::size_t> guided,
                         double longest) {
  const InertiaFreeSettings& settings = setup.integration.inertia_free;
  network_ = NetworkOperator(s.particles.size(), guided ? std::optional(Vec3(Vec3::UnitZ())) : std::nullopt);
  network_.reserve(s.contacts.size() + s.walls.contacts().size());
  Vector before(network_.rows());
  for (std::size_t p = 0; p < s.particles.size(); ++p)
    before.segment<3>(Eigen::Index(3 * p)) = s.particles.body[p].velocity;
  if (guided) before[network_.rows() - 1] = s.punch.velocity;

  const bool fixed = !std::isnan(settings.fixed_step);
  const double left = setup.schedule.next_breakpoint(s.time) - s.time;
  constexpr double first_share = 1e-4;  // of the way to the next breakpoint, when nothing is known yet
  double step = fixed ? settings.fixed_step : s.stable_step > 0 ? s.stable_step : first_share * left;
  const double proposed = step;
  double last_error = std::numeric_limits<double>::infinity();
  while (true) {
    step = std::min(step, longest);
    // Breakpoints of the schedule are met exactly; the last two steps before one share the way.
    double h = step;
    if (left <= h)
      h = left;
    else if (left < 2 * h)
      h = 0.5 * left;
    const Trial trial = prepare(s, setup, table, guided, h);
    velocity_ = before;
    const bool balanced = balance(s, setup, trial);
    const double error = balanced ? error_estimate(s, trial, before) / settings.step_tolerance : 0.0;
    constexpr double margin = 0.8, least = 0.2, most = 2, lessened = 0.9;
    // A contact that snaps open moves at once by what its spring held: no shorter step lessens that.
    const bool snapped = balanced && error > lessened * last_error;
    if (balanced) last_error = error;
    if (balanced && (fixed || error <= 1 || snapped)) {
      apply(s, trial);
      ++count_.steps;
      // The error goes as h^2 where the rates change steadily.
      const double factor = error > 0 ? std::clamp(margin / std::sqrt(error), least, most) : most;
      s.stable_step = fixed ? settings.fixed_step : std::max(factor * h, h < step ? std::min(step, most * h) : 0.0);
      return h;
    }
    ++count_.rejected;
    if (h < shortest_share * std::min(proposed, left))
      throw RunError("the forces cannot be balanced without inertia: " + std::to_string(resultant_.norm()) +
                     " N are left of " + std::to_string(force_scale_) +
                     " N; something may be loaded that nothing holds, or use integration.method = \"explicit\"");
    step = h * (balanced ? std::clamp(margin / std::sqrt(error), least, 0.6) : 0.3);
  }
}

std::size_t InertiaFree::bytes() const {
  return network_.links().capacity() * sizeof(NetworkLink) +
         std::size_t(velocity_.size() + resultant_.size() + change_.size() + external_.size()) * sizeof(double);
}

}  // namespace densify::dem
