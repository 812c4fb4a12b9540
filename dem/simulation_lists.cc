// When a simulation rebuilds its neighbour list and prunes the near list.

#include <limits>

#include "base/check.h"
#include "dem/simulation.h"

namespace densify::dem {

void Simulation::rebuild_lists() {
  const HistoryNeeds needs{setup_.contact.friction.has_value(),
                           setup_.contact.sintering && (table_.any_active() || !state_.contacts.neck.empty())};
  try {
    pass_.near().clear();  // room for the search
    const Eigen::Matrix3i change = state_.cell.periodic ? state_.cell.reduce() : Eigen::Matrix3i::Identity().eval();
    rebuild(state_.contacts, state_.particles, state_.cell, state_.expansion, needs, setup_.integration.threads,
            change);
  } catch (const InputError& error) {  // a cell that has become too narrow is no mistake of the input any more
    if (state_.steps == 0) throw;
    throw RunError(error.what());
  }
  state_.walls.rebuild(state_.particles, state_.contacts.skin);
  pass_.list_changed();
  prune_near(0);
}

void Simulation::keep_list_fresh() {
  const bool first_necks =
      setup_.contact.sintering && state_.contacts.neck.empty() && state_.contacts.size() > 0 && table_.any_active();
  bool rebuilding = first_necks || state_.walls.age(state_.contacts.skin) >= 1;
  // The list is rebuilt exactly when its own age says so, whatever was pruned since; the bound only spares looking.
  const NearList& near = pass_.near();
  const bool prune = near.empty() || !(may_have_travelled_ < near.skin()) || near.too_wide();
  if (!rebuilding && (prune || !(may_have_travelled_ < list_slack_))) {
    const double age =
        list_age(state_.contacts, state_.particles, state_.cell, state_.expansion, setup_.integration.threads);
    if (std::isnan(age)) require_finite(state_);
    // A step without inertia may use up half of the skin.
    rebuilding = age >= (state_.inertia_free ? 0.5 : 1.0);
    if (!rebuilding && prune)
      prune_near(age);
    else if (!rebuilding)
      set_list_slack(age);
  }
  if (rebuilding) rebuild_lists();
}

/// Called after a move in which no particle was faster than `fastest` against the flow of its cell [m/s, s].
void Simulation::note_travel(double fastest, double step) {
  const double flow = state_.cell.periodic ? state_.cell.velocity_gradient.norm() : 0.0;
  const double reach = 2 * state_.contacts.largest_radius + state_.contacts.skin;
  const double above = flow > 0 ? 1.5 : 1 + 1e-9;  // strains between two prunings multiply
  may_have_travelled_ += above * step * (2 * fastest + flow * reach);
}

void Simulation::set_list_slack(double list_age) {
  constexpr double rounding = 1e-9;  // of the sum of two distances
  list_slack_ = may_have_travelled_ + (1 - list_age - rounding) * state_.contacts.skin;
}

void Simulation::prune_near(double list_age) {
  pass_.near().prune(state_.contacts, state_.particles, state_.cell, setup_.integration.threads);
  pass_.near_changed(state_.contacts, state_.particles.size());
  may_have_travelled_ = 0;
  set_list_slack(list_age);
}

}  // namespace densify::dem
