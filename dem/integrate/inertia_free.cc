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

constexpr int most_newton = 16;            // solutions of one trial
constexpr double young_neck = 0.15;        // neck over radius below which a neck resists at least as one of this size
constexpr double breaking_share = 0.05;    // of the first trial, from which on a force that breaks away is accepted
constexpr double stress_tolerance = 1e-3;  // stress of a cell off its goal, over what the contacts carry
constexpr double breaking_force = 0.1;     // unbalanced over contact force that may break away in one step
constexpr double furthest_over_radius = 0.25;  // that a particle may move in one step
constexpr double furthest_over_skin = 0.25;    // likewise, so that no contact is met that the list does not hold
constexpr double smallest_force = 1e-300;      // [N], where nothing acts at all
constexpr double crawling_share = 1e-8;        // of the process, below which steps lead nowhere
constexpr int most_crawling = 10'000;          // of them in a row
constexpr double shortest_share = 1e-12;       // of the first trial, before a step counts as impossible

/// A contact at the end of a trial step.
struct StepContact {
  NormalInput input;      // there, but for the rate
  double growth_in_rate;  // thermal, as the law's rate counts it [m]
};

/// Force when the ends part at `rate` [m/s]: what the force pass will find there.
template <class Law>
NormalForce force_at_end(const Law& law, const NeckHistory* neck, const StepContact& c, double rate) {
  NormalInput in = c.input;
  in.rate = rate - c.growth_in_rate / in.step;
  if constexpr (has_necks<Law>) {
    NeckHistory after = *neck;
    if (after.phase == NeckPhase::loose && in.overlap >= 0) return {};
    return law.update(in, after);
  } else {
    return in.overlap >= 0 ? NormalForce{} : law.update(in);
  }
}

/// dF/d(rate) by a difference towards approach.  A young neck's own viscosity, which grows as a^4, would let it shoot
/// over; it resists at least as a share `young` of what a neck of 0.15 of the radius does.
template <class Law>
double coefficient(const Law& law, const NeckHistory* neck, const StepContact& c, double rate, double force,
                   double young) {
  constexpr double share = 1e-4, smallest = 1e-7;
  const NormalInput& in = c.input;
  const double change = std::max(share * std::abs(rate), smallest * in.elastic_radius / in.step);
  StepContact nearer = c;
  nearer.input.overlap -= change * in.step;
  double slope = std::max(0.0, (force - force_at_end(law, neck, nearer, rate - change).total) / change);
  if constexpr (has_necks<Law>)
    if (Law::flows(neck->phase)) {
      const double eta = young * law.viscosity(in, young_neck * in.sintering_radius);
      const double k = law.loose.spring.tangent(neck->elastic, in.elastic_radius);
      const double least = law.settings.model == SinteringModel::viscous ? eta : k * in.step / (1 + k * in.step / eta);
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
                                        std::optional<std::size_t> guided, double step, const CellStretch* stretch) {
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
  const double kept = std::max(1 / setup.integration.mass_scaling, setup.integration.inertia_free.mass_share);
  const double scaling = kept * setup.integration.mass_scaling;
  inertia_.resize(network_.rows());
  carried_ = before_;
  carried_.head(3 * Eigen::Index(s.particles.size())) *= std::exp(-t.step / memory(s, setup, scaling));
  for (std::size_t p = 0; p < s.particles.size(); ++p)
    inertia_.segment<3>(Eigen::Index(3 * p)).setConstant(scaling / (s.particles.body[p].inverse_mass * t.step));
  if (guided) inertia_[network_.rows() - 1] = kept * s.punch.mass / t.step;
  if (stretch) {
    cell_.begin(s, *stretch, t.step);
    return t;
  }
  double mass = 0;
  for (const Body& b : s.particles.body) mass += scaling / b.inverse_mass;
  cell_.begin(s, setup, t.step, t.end, mass);
  return t;
}

/// The time in which the masses that hold what no contact holds would swing on their contacts [s].  Motion is forgotten
/// within it: a particle that flies in its cage for ever would end every step before its neighbours.
double InertiaFree::memory(const State& s, const Setup& setup, double scaling) const {
  double mass = 0, stiffness = 0;
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    const std::uint8_t m = s.particles.material[p];
    mass += scaling / s.particles.body[p].inverse_mass;
    stiffness += with_spring(setup.contact, table_->row(m, m), [&](const auto& spring) {
      return spring.reference_stiffness(s.particles.body[p].radius);
    });
  }
  return std::sqrt(mass / stiffness);
}

/// Particles, cell and walls as they will be at the end of the step with the present velocities.
void InertiaFree::look_ahead(const State& s, const Trial& t) {
  const bool deforming = s.cell.periodic && !cell_.gradient().isZero(0);
  const Mat3 flow = t.step * cell_.gradient();
  ahead_.material = s.particles.material;
  ahead_.body = s.particles.body;
  for (std::size_t p = 0; p < ahead_.size(); ++p) {
    Body& b = ahead_.body[p];
    if (deforming) b.position += flow * (b.position - s.cell.origin);
    b.velocity = velocity_.segment<3>(Eigen::Index(3 * p));
    b.position += t.step * b.velocity;
    b.radius *= 1 + growth_[ahead_.material[p]];
  }
  cell_ahead_ = s.cell;
  if (deforming) cell_ahead_.h += flow * s.cell.h;
  walls_ahead_ = s.walls;
  for (std::size_t w = 0; w < walls_ahead_.wall.size(); ++w) {
    Wall& wall = walls_ahead_.wall[w];
    if (t.guided == w) wall.velocity = velocity_[network_.rows() - 1] * Vec3::UnitZ();
    wall.move(t.step);
    wall.stretch(t.wall_stretch);
  }
}

void InertiaFree::respond(const State& s, const Setup& setup, const Trial& t, double young) {
  look_ahead(s, t);
  network_.clear();
  network_.resist(inertia_);
  resultant_ = external_ - inertia_.cwiseProduct(velocity_ - carried_);
  double squares = external_.squaredNorm();
  const bool deforming = s.cell.periodic && !cell_.gradient().isZero(0);
  cell_.clear(network_.rows());
  forces_.clear();
  const double lateral_share = setup.integration.inertia_free.tangential_share;
  // Pores close with the powder's density, as they will have when the next pass meets them.
  if (pores_.density)
    pores_.scale = powder_density(ahead_, powder_room(ahead_, cell_ahead_, walls_ahead_)) / s.local_density.powder;
  const ContactWorld world{ahead_, s.contacts, cell_ahead_, *table_, setup.contact, walls_ahead_, pores_};
  visit_contacts(world, 0, [&](const ContactView& view, const auto& law, const NeckHistory* neck) {
    NetworkLink link{view.normal, 0, 0, view.i, view.j, End::particle};
    StepContact c{view.input, 0};
    c.input.step = t.step;
    c.input.time = t.end;
    const Body& a = ahead_.body[view.i];
    // Relative growths over the step, of the radii at its end.
    const double grown_i = growth_[ahead_.material[view.i]] / (1 + growth_[ahead_.material[view.i]]);
    Vec3 motion;
    if (view.at_wall) {
      const Wall& wall = walls_ahead_.wall[view.j];
      const bool guided = t.guided && view.j == *t.guided;
      link.end = guided ? End::guided_wall : End::fixed_wall;
      motion = network_.relative(link, velocity_);
      if (wall.shape == WallShape::cylinder)
        motion += wall.radius_rate * view.normal;
      else if (!guided)
        motion += wall.velocity;
      c.growth_in_rate = grown_i * a.radius;
    } else {
      const Body& b = ahead_.body[view.j];
      const double grown_j = growth_[ahead_.material[view.j]] / (1 + growth_[ahead_.material[view.j]]);
      motion = network_.relative(link, velocity_);
      if (deforming) motion += cell_.gradient() * view.branch;
      c.growth_in_rate = thermal_growth(a.radius, b.radius, view.input.overlap, grown_i, grown_j,
                                        neck && neck->phase != NeckPhase::loose);
    }
    const double rate = motion.dot(view.normal);
    const NormalForce force = force_at_end(law, neck, c, rate);
    link.coefficient = coefficient(law, neck, c, rate, force.total, young);
    link.lateral = lateral_share * link.coefficient;
    const Vec3 on_i = force.total * view.normal + link.lateral * (motion - rate * view.normal);
    network_.add_force(link, on_i, resultant_);
    // The force turns with the branch: what pulls holds its ends across, as a string does.  What pushes lets them go,
    // which the matrix leaves out to stay definite.
    if (!view.at_wall) link.lateral += t.step * std::max(0.0, force.total) / view.branch.norm();
    network_.add(link);
    forces_.push_back({view.branch, on_i});
    if (cell_.balances()) cell_.add(network_, link, view.branch, on_i);
    const double passive = force.total - force.sintering;  // the two may cancel
    squares += passive * passive + force.sintering * force.sintering;
  });
  force_scale_ = std::sqrt(squares);
  if (cell_.balances()) cell_.close(cell_ahead_.volume());
}

bool InertiaFree::balance(const State& s, const Setup& setup, const Trial& t) {
  const double goal = setup.integration.inertia_free.force_tolerance;
  double best = std::numeric_limits<double>::infinity();
  Vector best_velocity = velocity_;
  Mat3 best_gradient = cell_.gradient();
  constexpr double falling = 0.1;
  double young = 1;
  for (int n = 0;; ++n) {
    young = std::pow(falling, n);
    respond(s, setup, t, young);
    const double residual = resultant_.norm();
    const double share =
        std::max(residual / std::max(force_scale_, smallest_force), goal * cell_.off() / stress_tolerance);
    if (share <= goal) return true;
    if (share < best) {
      best = share;
      best_velocity = velocity_;
      best_gradient = cell_.gradient();
    }
    if (n == most_newton || !std::isfinite(share)) break;
    constexpr double forcing = 0.1, within_goal = 0.3;
    change_.setZero(network_.rows());
    const SolverReport report =
        network_.solve(resultant_, change_, {std::max(forcing * residual, within_goal * goal * force_scale_), 0});
    ++count_.solutions;
    count_.iterations += std::uint64_t(report.iterations);
    if (cell_.balances()) count_.iterations += std::uint64_t(cell_.solve(network_, change_));
    // Contacts that open and close from one iterate to the next come to rest on half the way.
    constexpr int whole_steps = 10;
    const double factor = n < whole_steps ? 1.0 : 0.5;
    velocity_ += factor * change_;
    if (cell_.balances()) cell_.advance(factor);
  }
  velocity_ = best_velocity;
  cell_.set_gradient(best_gradient);
  respond(s, setup, t, young);
  return false;
}

double InertiaFree::error_estimate(const State& s, const Trial& t) const {
  double radius = 0, sum = 0;
  for (const double r : s.particles.reference_radius) radius += r / double(s.particles.size());
  const Vector difference = velocity_ - before_;
  for (std::size_t k = 0; k < network_.links().size(); ++k) {
    const NetworkLink& link = network_.links()[k];
    double along = network_.relative(link, difference).dot(link.normal);
    if (cell_.changes()) along += cell_.change_along(forces_[k], link.normal);
    sum += std::abs(along);
  }
  const double count = std::max<double>(1, double(network_.links().size()));
  return 0.5 * t.step * sum / count / radius;
}

void InertiaFree::apply(State& s, const Trial& t) const {
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    s.particles.body[p].velocity = ahead_.body[p].velocity;
    s.particles.body[p].position = ahead_.body[p].position;
  }
  s.cell.h = cell_ahead_.h;
  s.cell.velocity_gradient = cell_.gradient();
  if (s.cell_drive.stage != CellDrive::no_stage) {
    CellDrive& drive = s.cell_drive;
    for (std::size_t c = 0; c < 6; ++c) drive.mean[c] = cell_.gradient()(tensor_places[c][0], tensor_places[c][1]);
    drive.slope.fill(0);
    drive.deformation += t.step * cell_.gradient() * drive.deformation;
  }
  if (t.guided) {
    s.punch.velocity = s.punch.mean_velocity = velocity_[network_.rows() - 1];
    s.punch.mean_acceleration = 0;
    s.walls.wall[*t.guided].velocity = walls_ahead_.wall[*t.guided].velocity;
  }
  for (auto& w : s.walls.wall) w.move(t.step);
}

double InertiaFree::move(State& s, const Setup& setup, const PairTable& table, const PoreClosure& pores,
                         std::optional<std::size_t> guided, double longest, const CellStretch* stretch) {
  pores_ = pores;
  const InertiaFreeSettings& settings = setup.integration.inertia_free;
  network_ = NetworkOperator(s.particles.size(), guided ? std::optional(Vec3(Vec3::UnitZ())) : std::nullopt);
  network_.reserve(s.contacts.size() + s.walls.contacts().size());
  forces_.reserve(s.contacts.size() + s.walls.contacts().size());
  before_.resize(network_.rows());
  for (std::size_t p = 0; p < s.particles.size(); ++p)
    before_.segment<3>(Eigen::Index(3 * p)) = s.particles.body[p].velocity;
  if (guided) before_[network_.rows() - 1] = s.punch.velocity;

  const bool fixed = !std::isnan(settings.fixed_step);
  const double breakpoint = setup.schedule.next_breakpoint(s.time);
  const double left = (stretch ? std::min(stretch->end, breakpoint) : breakpoint) - s.time;
  // Of the way to the next breakpoint, when nothing is known yet; an owner's way is a step of his already.
  const double first_share = stretch ? 1 : 1e-4;
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
    const Trial trial = prepare(s, setup, table, guided, h, stretch);
    velocity_ = stretch && stretch->guess && h == left ? *stretch->guess : before_;
    // A contact that breaks lets go of its force at once: no shorter step balances it, the next one does.
    const bool solved = balance(s, setup, trial);
    const bool breaks = !solved && h < breaking_share * std::min(proposed, left) &&
                        resultant_.norm() <= breaking_force * force_scale_ && cell_.off() <= breaking_force;
    // How much further than it may a particle went: a step long enough to meet what the list does not hold is tried
    // again.
    const double reach = 2 * s.contacts.largest_radius + s.contacts.skin;
    double furthest = h * cell_.gradient().norm() * reach / (furthest_over_skin * s.contacts.skin);
    for (const Body& b : ahead_.body)
      furthest =
          std::max(furthest, h * b.velocity.norm() /
                                 std::min(furthest_over_radius * b.radius, furthest_over_skin * s.contacts.skin));
    const bool balanced = (solved || breaks) && furthest <= 1;
    const double error = balanced ? error_estimate(s, trial) / settings.step_tolerance : 0.0;
    constexpr double margin = 0.8, least = 0.2, most = 2, lessened = 0.9;
    // A contact that snaps open moves at once by what its spring held: no shorter step lessens that.
    const bool snapped = balanced && error > lessened * last_error;
    if (balanced) last_error = error;
    if (balanced && (fixed || breaks || error <= 1 || snapped)) {
      apply(s, trial);
      error_ = error * settings.step_tolerance;
      ++count_.steps;
      crawling_ = h < crawling_share * setup.schedule.end() && h < left ? crawling_ + 1 : 0;
      if (crawling_ > most_crawling)
        throw RunError(
            "steps without inertia have been shorter than 1e-8 of the process for " + std::to_string(most_crawling) +
            " steps in a row; something moves that nothing holds, try a "
            "larger integration.inertia_free.mass_share or tangential_share, or integration.method = \"explicit\"");
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
    constexpr double most_of_trial = 0.6, unsolved = 0.3;
    step = h * (balanced       ? std::clamp(margin / std::sqrt(error), least, most_of_trial)
                : furthest > 1 ? std::clamp(margin / furthest, least * least, most_of_trial)
                               : unsolved);
  }
}

/// Links as the whole of several steps sees them, of which the last was `last` long: springs give way all the time,
/// dashpots only flow.
void InertiaFree::respond_over(const State& s, const Setup& setup, double whole, double last) {
  std::vector<NetworkLink> links = network_.links();
  const double lateral_share = setup.integration.inertia_free.tangential_share;
  std::size_t k = 0;
  visit_contacts({ahead_, s.contacts, cell_ahead_, *table_, setup.contact, walls_ahead_, pores_}, 0,
                 [&](const ContactView& view, const auto& law, const NeckHistory* neck) {
                   NormalInput in = view.input;
                   in.time = s.time;
                   Linearisation l;
                   if constexpr (has_necks<std::decay_t<decltype(law)>>)
                     l = law.linearise(in, *neck);
                   else
                     l = law.linearise(in);
                   NetworkLink& link = links[k++];
                   const double across = link.lateral - lateral_share * link.coefficient;  // as a string
                   link.coefficient = frozen_step(l, whole).coefficient;
                   link.lateral = lateral_share * link.coefficient + across * whole / last;
                 });
  network_.clear();
  for (const NetworkLink& link : links) network_.add(link);
  network_.resist(last / whole * inertia_);
}

CellTangent InertiaFree::tangent(const State& s, const Setup& setup, double whole) {
  if (whole > s.last_step) respond_over(s, setup, whole, s.last_step);
  return cell_tangent(network_, forces_, cell_ahead_.volume());
}

std::size_t InertiaFree::bytes() const {
  return forces_.capacity() * sizeof(LinkForce) + network_.links().capacity() * sizeof(NetworkLink) +
         ahead_.body.capacity() * sizeof(Body) + ahead_.material.capacity() +
         walls_ahead_.contacts().capacity() * sizeof(walls_ahead_.contacts()[0]) +
         std::size_t(velocity_.size() + resultant_.size() + change_.size() + external_.size() + before_.size() +
                     carried_.size() + inertia_.size()) *
             sizeof(double);
}

}  // namespace densify::dem
