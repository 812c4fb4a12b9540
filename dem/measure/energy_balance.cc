#include "dem/measure/energy_balance.h"

#include <cmath>

namespace densify::dem {

namespace {

/// Mean force of a spring while its displacement goes from one to another.
template <class Spring>
double mean_force(const Spring& spring, double from, double to, double radius) {
  constexpr double no_way = 1e-6;  // below, the difference of energies is mere rounding
  if (std::abs(to - from) <= no_way * std::abs(to)) return spring.force(0.5 * (from + to), radius);
  return (spring.energy(to, radius) - spring.energy(from, radius)) / (to - from);
}

}  // namespace

void EnergyBalance::evaluate(Simulation& sim, Recording& recording, EnergySums& sums) {
  const std::vector<double> expansion = sim.state().expansion;
  std::vector<double> modulus(sim.table().materials() * sim.table().materials());
  for (std::uint8_t a = 0; a < sim.table().materials(); ++a)
    for (std::uint8_t b = a; b < sim.table().materials(); ++b)
      modulus[sim.table().index(a, b)] = sim.table().row(a, b).four_thirds_modulus;
  sim.refresh();
  neck_before_ = sim.state().contacts.neck;
  sim.evaluate(&recording);
  add_contacts(sim, recording, modulus, expansion, sums);
  add_half(sim, recording, sim.state().last_step, sums);
}

void EnergyBalance::move(Simulation& sim, const Recording& recording, EnergySums& sums) {
  sim.move();
  add_half(sim, recording, sim.state().last_step, sums);
}

/// What belongs to the whole step that led to this evaluation.
void EnergyBalance::add_contacts(const Simulation& sim, const Recording& recording,
                                 const std::vector<double>& modulus_before, const std::vector<double>& expansion_before,
                                 EnergySums& sums) {
  const State& s = sim.state();
  const ContactList& list = s.contacts;
  const ContactModel& model = sim.setup().contact;
  std::vector<double> shrink(s.expansion.size());  // of radii, to those before
  for (std::size_t m = 0; m < shrink.size(); ++m) shrink[m] = expansion_before[m] / s.expansion[m];
  const ImageShifts shifts(s.cell);
  link_.resize(list.size());
  sums.stored = 0;
  for (const auto& bucket : list.buckets) {
    const PairProperties& row = sim.table().row(bucket.material_a, bucket.material_b);
    const double before = modulus_before[sim.table().index(bucket.material_a, bucket.material_b)];
    const bool hertz = model.elasticity == Elasticity::hertz;
    with_law(model, row, !list.neck.empty(), [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      const auto& spring = spring_of(law);
      for (std::size_t k = bucket.begin; k < bucket.end; ++k) {
        const ContactRecord& record = recording.contact[k];
        if (!record.touching) continue;
        const Body &a = s.particles.body[list.i(k)], &b = s.particles.body[list.j(k)];
        Link& link = link_[k];
        link.branch = b.position - a.position + shifts[list.image(k)];
        const double distance = link.branch.norm(), overlap = distance - a.radius - b.radius;
        const std::uint8_t material_i = s.particles.material[list.i(k)], material_j = s.particles.material[list.j(k)];
        const bool necked = !neck_before_.empty() && neck_before_[k].phase != NeckPhase::loose;
        const double grown =
            thermal_growth(a.radius, b.radius, overlap, 1 - shrink[material_i], 1 - shrink[material_j], necked);
        link.growth_rate = s.last_step > 0 ? grown / s.last_step : 0.0;
        const double radius = elastic_radius(model, a.radius, b.radius);
        sums.stored += record.elastic_energy;
        if (hertz && record.elastic_energy > 0) {
          const double was = elastic_radius(model, shrink[material_i] * a.radius, shrink[material_j] * b.radius);
          sums.stiffness += record.elastic_energy * (1 - before / row.four_thirds_modulus * std::sqrt(was / radius));
        }
        if constexpr (has_necks<Law>) {
          const NeckHistory &was = neck_before_[k], &is = list.neck[k];
          if (is.phase == NeckPhase::loose || s.last_step == 0) continue;
          const Vec3 parting = b.velocity - a.velocity + s.cell.velocity_gradient * link.branch;
          const double way = s.last_step * parting.dot(link.branch) / distance - grown;
          const double passive = record.normal - record.sintering - record.damping;
          const double u = was.phase == NeckPhase::loose ? std::min(0.0, overlap - way) : was.elastic;
          if (law.settings.model == SinteringModel::viscous && Law::flows(is.phase))
            sums.viscous += passive * way + (Law::flows(was.phase) ? 0.0 : spring.energy(u, radius));
          else
            sums.viscous += mean_force(spring, u, is.elastic, radius) * (way - (is.elastic - u));
        }
      }
    });
  }
  if (std::isnan(sums.stored_first)) sums.stored_first = sums.stored;
}

/// What the forces of this evaluation do in half of a step with the present velocities, in one order.
void EnergyBalance::add_half(const Simulation& sim, const Recording& recording, double step, EnergySums& sums) const {
  const State& s = sim.state();
  const double half = 0.5 * step;
  for (std::size_t k = 0; k < recording.contact.size(); ++k) {
    const ContactRecord& record = recording.contact[k];
    if (!record.touching) continue;
    const Link& link = link_[k];
    const Vec3 flow = s.cell.velocity_gradient * link.branch;
    const Vec3 parting = s.particles.body[s.contacts.j(k)].velocity - s.particles.body[s.contacts.i(k)].velocity + flow;
    const double along = parting.dot(link.branch) / link.branch.norm(), way = half * (along - link.growth_rate);
    sums.boundary += half * record.force.dot(flow);
    sums.sintering -= record.sintering * way;
    sums.expansion -= half * link.growth_rate * record.normal;
    sums.damping += record.damping * way;
    sums.friction += half * (record.force.dot(parting) - record.normal * along);
  }
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    sums.motion += half * s.particles.force[p].dot(s.particles.body[p].velocity);
    if (s.particles.torque.empty()) continue;
    const double turning = half * s.particles.torque[p].dot(s.particles.angular_velocity[p]);
    sums.motion += turning;
    sums.friction -= turning;
  }
}

}  // namespace densify::dem
