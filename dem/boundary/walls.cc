#include "dem/boundary/walls.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/check.h"
#include "dem/law/friction.h"

namespace densify::dem {

double Walls::gap(const Wall& w, const Vec3& x, Vec3& toward_wall) {
  if (w.shape == WallShape::plane) {
    toward_wall = -w.normal;
    return (x - w.point).dot(w.normal);
  }
  const Vec3 r(x[0] - w.point[0], x[1] - w.point[1], 0);
  const double rho = r.norm();
  toward_wall = rho > 0 ? Vec3(r / rho) : Vec3(Vec3::UnitX());
  return w.radius - rho;
}

namespace {

[[noreturn]] void refuse_escape(std::uint32_t id, const Wall& wall) {
  throw RunError("particle " + std::to_string(id) + " has left the " + wall.name +
                 ": its centre is beyond the wall; the step or the mass factor is too large, or the wall too soft");
}

/// Spares the root where a particle is inside a cylinder without touching it.
bool clearly_apart(const Wall& w, const Body& b) {
  constexpr double rounding = 1e-12;
  if (w.shape != WallShape::cylinder) return false;
  const double x = b.position[0] - w.point[0], y = b.position[1] - w.point[1], reach = w.radius - b.radius;
  return reach > 0 && x * x + y * y < reach * reach * (1 - rounding);
}

}  // namespace

void Walls::require_inside(const Particles& particles) const {
  Vec3 n;
  for (const auto& c : contacts_)
    if (gap(wall[c.wall], particles.body[c.particle].position, n) < 0)
      refuse_escape(particles.id[c.particle], wall[c.wall]);
}

void Walls::rebuild(const Particles& particles, double skin) {
  std::vector<WallContact> fresh;
  Vec3 n;
  for (std::size_t w = 0; w < wall.size(); ++w)
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double g = gap(wall[w], particles.body[p].position, n);
      if (g < 0) refuse_escape(particles.id[p], wall[w]);
      if (g < particles.body[p].radius + skin) fresh.push_back({std::uint32_t(p), std::uint8_t(w), Vec3::Zero()});
    }
  auto less = [](const WallContact& a, const WallContact& b) {
    return a.wall != b.wall ? a.wall < b.wall : a.particle < b.particle;
  };
  for (auto& c : fresh) {  // both lists are sorted by (wall, particle)
    const auto old = std::lower_bound(contacts_.begin(), contacts_.end(), c, less);
    if (old != contacts_.end() && old->wall == c.wall && old->particle == c.particle) c.tangential = old->tangential;
  }
  contacts_ = std::move(fresh);
  reference_ = wall;
}

double Walls::age(double skin) const {
  double moved = 0;
  for (std::size_t w = 0; w < wall.size(); ++w)
    moved = std::max({moved, std::abs((wall[w].point - reference_[w].point).dot(wall[w].normal)),
                      std::abs(wall[w].radius - reference_[w].radius)});
  return 2 * moved / skin;
}

double Walls::modulus(const PairTable& table, const ContactModel& model, std::uint8_t material) const {
  // The pair row holds (4/3) E* of two like particles; a wall replaces one of them by its own compliance.
  const double like = table.row(material, material).four_thirds_modulus;
  if (std::isnan(material_.youngs_modulus)) return 2 * like;
  const double one = 4.0 / 3 * model.stiffness_factor / (2 * like);  // (1 - nu^2)/E of the particle
  const double wall_compliance = (1 - material_.poissons_ratio * material_.poissons_ratio) / material_.youngs_modulus;
  return 4.0 / 3 * model.stiffness_factor / (one + wall_compliance);
}

void Walls::compute(Particles& particles, const PairTable& table, const ContactModel& model,
                    const std::vector<double>& expansion_step, PassTime clock, std::vector<WallRecord>* record,
                    StepStiffness* step_stiffness) {
  force_.assign(wall.size(), Vec3::Zero());
  normal_force_.assign(wall.size(), 0);
  if (record) record->clear();
  if (step_stiffness) {
    stiffness_.assign(wall.size(), 0);
    step_stiffness_.assign(wall.size(), 0);
  }
  moduli_.resize(table.materials());
  growth_rates_.resize(table.materials());
  for (std::size_t m = 0; m < moduli_.size(); ++m) {
    moduli_[m] = modulus(table, model, std::uint8_t(m));
    growth_rates_[m] = clock.step > 0 ? expansion_step[m] / clock.step : 0.0;
  }
  Vec3 n;
  for (auto& c : contacts_) {
    const Wall& w = wall[c.wall];
    const Body& b = particles.body[c.particle];
    if (clearly_apart(w, b)) {
      c.tangential.setZero();
      continue;
    }
    const double g = gap(w, b.position, n);
    if (g >= b.radius) {
      c.tangential.setZero();
      continue;
    }
    const Vec3 wall_velocity = w.shape == WallShape::plane ? Vec3(w.velocity + w.thermal_rate * w.point)
                                                           : Vec3((w.radius_rate + w.thermal_rate * w.radius) * n);
    const Vec3 v = wall_velocity - b.velocity;
    const double vn = v.dot(n);
    const std::uint8_t m = particles.material[c.particle];
    const NormalInput in = wall_input(b, g, vn - growth_rates_[m] * b.radius, clock);
    with_wall_law(model, moduli_[m], [&](const auto& law) {
      const double fn = law.update(in).total;
      Vec3 f = fn * n;
      if (model.friction) {
        const double lever = g;
        const Vec3 spin = lever * particles.angular_velocity[c.particle];
        const TangentialInput t{n,
                                v - vn * n - spin.cross(n),
                                std::max(0.0, -fn),
                                law.spring.tangent(in.overlap, in.elastic_radius),
                                in.reduced_mass,
                                clock.step};
        const Vec3 ft = coulomb(*model.friction, model.friction->wall_coefficient, t, c.tangential);
        f += ft;
        particles.torque[c.particle] += lever * n.cross(ft);
      }
      particles.force[c.particle] += f;
      force_[c.wall] -= f;
      normal_force_[c.wall] -= fn;
      if (step_stiffness) {
        const double k = law.spring.tangent(in.overlap, in.elastic_radius);
        const double along = law.step_stiffness(in, step_stiffness->next_step);
        const double across =
            model.friction ? tangential_step_stiffness(*model.friction, k, in.reduced_mass, step_stiffness->next_step)
                           : 0.0;
        StiffnessSum& sum = step_stiffness->of[c.particle];
        sum.add(along, across, n);
        sum.force += std::abs(fn);
        stiffness_[c.wall] += k;
        step_stiffness_[c.wall] += along;
      }
      if (record) record->push_back({c.particle, c.wall, f, g * n, law.spring.energy(in.overlap, in.elastic_radius)});
    });
  }
}

template <class Visit>
void Walls::each_touching(const Particles& particles, const PairTable& table, const ContactModel& model,
                          Visit&& visit) const {
  Vec3 n;
  for (const auto& c : contacts_) {
    const Body& b = particles.body[c.particle];
    const double g = gap(wall[c.wall], b.position, n);
    if (g >= b.radius) continue;
    const NormalInput in = wall_input(b, g, 0, {0, 0});
    with_wall_law(model, modulus(table, model, particles.material[c.particle]),
                  [&](const auto& law) { visit(c, n, in, law); });
  }
}

double Walls::elastic_energy(const Particles& particles, const PairTable& table, const ContactModel& model) const {
  double sum = 0;
  each_touching(particles, table, model,
                [&](const WallContact& c, const Vec3&, const NormalInput& in, const auto& law) {
                  sum += law.spring.energy(in.overlap, in.elastic_radius);
                  if (model.friction)
                    sum += 0.5 * model.friction->tangential_stiffness_ratio *
                           law.spring.tangent(in.overlap, in.elastic_radius) * c.tangential.squaredNorm();
                });
  return sum;
}

void Walls::add_stiffness(const Particles& particles, const PairTable& table, const ContactModel& model,
                          std::vector<NodeSums>& sums) {
  stiffness_.assign(wall.size(), 0);
  damping_.assign(wall.size(), 0);
  each_touching(particles, table, model,
                [&](const WallContact& c, const Vec3& n, const NormalInput& in, const auto& law) {
                  const Linearisation l = law.linearise(in), across = tangential_share(l, model, in.reduced_mass);
                  sums[c.particle].stiffness.add(l.stiffness, across.stiffness, n);
                  sums[c.particle].damping.add(l.damper, across.damper, n);
                  stiffness_[c.wall] += l.stiffness;
                  damping_[c.wall] += l.damper;
                });
}

}  // namespace densify::dem
