#include "dem/network/network.h"

#include <numeric>

namespace densify::dem {

Network build_network(const ContactWorld& world, double time) {
  Network network;
  network.particles = world.particles.size();
  visit_contacts(world, 0, [&](const ContactView& view, const auto& law, const NeckHistory* neck) {
    using Law = std::decay_t<decltype(law)>;
    NormalInput in = view.input;
    in.time = time;
    NetworkEdge edge{view.i, view.j, view.at_wall, view.place, view.normal, view.branch, in.overlap, 0, 0, {}};
    edge.lever = view.at_wall ? view.branch.norm() : world.particles.body[view.i].radius + 0.5 * in.overlap;
    if constexpr (has_necks<Law>) {
      edge.law = law.linearise(in, *neck);
      if (neck->phase != NeckPhase::loose) edge.neck_radius = neck->radius;
    } else {
      edge.law = law.linearise(in);
    }
    network.edges.push_back(edge);
  });
  return network;
}

std::vector<bool> find_rattlers(const Network& network, std::size_t least) {
  std::vector<std::size_t> count(network.particles, 0), begin(network.particles + 1, 0);
  for (const auto& e : network.edges) {
    ++count[e.i];
    if (!e.at_wall) ++count[e.j], ++begin[e.i + 1], ++begin[e.j + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> neighbour(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const auto& e : network.edges)
    if (!e.at_wall) neighbour[next[e.i]++] = e.j, neighbour[next[e.j]++] = e.i;
  std::vector<bool> out(network.particles, false);
  std::vector<std::uint32_t> fallen;
  auto drop = [&](std::uint32_t p) {
    if (out[p] || count[p] >= least) return;
    out[p] = true;
    fallen.push_back(p);
  };
  for (std::uint32_t p = 0; p < network.particles; ++p) drop(p);
  while (!fallen.empty()) {
    const std::uint32_t p = fallen.back();
    fallen.pop_back();
    for (std::size_t q = begin[p]; q < begin[p + 1]; ++q) {
      --count[neighbour[q]];
      drop(neighbour[q]);
    }
  }
  return out;
}

FrozenStep frozen_step(const Linearisation& l, double step) {
  if (std::isinf(l.stiffness)) return {l.active, l.viscosity};
  const double relaxed = 1 + step * l.stiffness / l.viscosity;  // 1 for a contact without flow
  return {l.active + l.stored * (1 - l.damper / l.viscosity) / relaxed, (l.stiffness * step + l.damper) / relaxed};
}

}  // namespace densify::dem
