#include "fem/press/press_body.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <numeric>

#include "base/check.h"
#include "fem/press/axes.h"
#include "fem/press/step_refused.h"

namespace densify::fem {

namespace {

constexpr double held_share = 0.01;        // of the largest slip of a step, that friction holds back like a spring
constexpr int iterations_that_choose = 4;  // that spring's stiffness
constexpr int most_looks = 8;              // at places along a change of Newton's method
constexpr int most_rounds = 30;            // of opening and closing points of the wall

double sum(double value, MPI_Comm comm) {
  return dealii::Utilities::MPI::sum(value, comm);
}

}  // namespace

template <int dim>
PressBody<dim>::PressBody(const CylinderSize& size, std::shared_ptr<PointMaterial> material, double density,
                          double temperature, const PressSettings& settings, MPI_Comm comm)
    : comm_(comm),
      settings_(settings),
      material_(std::move(material)),
      radius_(size.radius),
      height_(size.height),
      mesh_(comm, dealii::Triangulation<dim>::none, false,
            dealii::parallel::shared::Triangulation<dim>::partition_custom_signal),
      element_(dealii::FE_Q<dim>(unsigned(settings.degree)), dim),
      mapping_(unsigned(settings.degree)),
      points_of_cell_(unsigned(settings.degree) + 1),
      points_of_face_(unsigned(settings.degree) + 1),
      dofs_(mesh_),
      solver_(comm),
      start_temperature_(temperature),
      temperature_(temperature) {
  mesh_.signals.create.connect([&] {  // ranks have elements in their order: see gathered.h
    const auto ranks = dealii::Utilities::MPI::n_mpi_processes(comm_);
    for (const auto& cell : mesh_.active_cell_iterators())
      cell->set_subdomain_id(cell->active_cell_index() * ranks / mesh_.n_active_cells());
  });
  make_cylinder(mesh_, size);
  dofs_.distribute_dofs(element_);
  displacement_.reinit(dofs_.n_dofs());
  before_ = tried_ = displacement_;
  make_constraints();
  make_points(density);
}

template <int dim>
void PressBody<dim>::make_constraints() {
  using namespace dealii;
  const auto axial = [&] {
    ComponentMask mask(dim, false);
    mask.set(dim - 1, true);
    return mask;
  }();
  const auto sorted = [&](const ComponentMask& mask, Face face) {
    const IndexSet set = DoFTools::extract_boundary_dofs(dofs_, mask, {face});
    return Dofs(set.begin(), set.end());
  };
  top_ = sorted(axial, top);
  bottom_ = sorted(axial, bottom);
  punch_.assign(dofs_.n_dofs(), 0);
  for (const auto d : top_) punch_[d] = 1;
  for (const auto d : bottom_) punch_[d] = 2;
  const auto guide = [&](AffineConstraints<double>& c) {
    for (int side = 0; side < dim - 1; ++side) {
      ComponentMask mask(dim, false);
      mask.set(unsigned(side), true);
      for (const auto d : sorted(mask, side == 0 ? symmetry_x : symmetry_y)) c.add_line(d);
    }
  };
  const auto follow = [&](AffineConstraints<double>& c, const Dofs& all, double share) {
    for (const auto d : all)
      if (d != top_.front()) {
        c.add_line(d);
        c.add_entry(d, top_.front(), share);
      }
  };
  for (auto* c : {&pressed_, &both_, &driven_}) guide(*c);
  for (const auto d : bottom_) pressed_.add_line(d), driven_.add_line(d);
  for (const auto d : top_) driven_.add_line(d);
  follow(pressed_, top_, 1);
  follow(both_, top_, 1);
  follow(both_, bottom_, -1);
  for (auto* c : {&pressed_, &both_, &driven_}) c->close();

  DynamicSparsityPattern pattern(dofs_.n_dofs());
  DoFTools::make_sparsity_pattern(dofs_, pattern, settings_.punches == Punches::both ? both_ : pressed_, true);
  const IndexSet& owned = dofs_.locally_owned_dofs();
  SparsityTools::distribute_sparsity_pattern(pattern, owned, comm_, DoFTools::extract_locally_relevant_dofs(dofs_));
  matrix_.reinit(owned, owned, pattern, comm_);
  residual_.reinit(owned, comm_);
  change_.reinit(owned, comm_);
}

template <int dim>
void PressBody<dim>::make_points(double density) {
  dealii::FEValues<dim> values(mapping_, element_, points_of_cell_,
                               dealii::update_JxW_values | dealii::update_quadrature_points);
  std::size_t wall_points = 0;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    for (const unsigned q : values.quadrature_point_indices())
      weight_.push_back(values.JxW(q) * around<dim>(values.quadrature_point(q)[0]));
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == wall) wall_points += points_of_face_.size();
  }
  area_ = sum(std::accumulate(weight_.begin(), weight_.end(), 0.0), comm_) / height_;
  motion_.resize(weight_.size());
  for (PointMotion& m : motion_) m.before = m.after = Mat3::Identity();
  step_.resize(weight_.size());
  answer_.resize(weight_.size());
  const std::size_t n = material_->state_size();
  state_.resize(n * weight_.size());
  material_->begin(density, state_);
  tried_state_ = state_;
  friction_.assign(wall_points, Vec3::Zero());
  tried_friction_ = friction_;
  accepted_closed_.assign(wall_points, 1);  // the body fills its die
  closed_ = covered_ = accepted_closed_;
  depth_.assign(wall_points, 0.0);
}

template <int dim>
PressOutcome PressBody<dim>::try_step(const PressLoad& load) {
  const auto& pressed = load.moving == Punches::both ? both_ : pressed_;
  tried_temperature_ = load.temperature;
  tried_step_ = load.step;
  tried_ = displacement_;
  if (last_step_ > 0)  // as the last step went on
    tried_.sadd(1 + load.step / last_step_, -load.step / last_step_, before_);
  if (load.moving == Punches::upper)
    for (const auto d : bottom_) tried_[d] = displacement_[d];
  closed_ = accepted_closed_;
  punch_closed_ = load.pressure || accepted_punch_closed_;
  if (driven(load)) place_punches(load);
  solver_.forget();  // so that a step is the same after a checkpoint
  if (material_->affine()) {
    agreed([&] { strain_points(load, tried_); });
    material_->begin_step(step_);
  }
  PressOutcome outcome;
  for (outcome.rounds = 1;; ++outcome.rounds) {
    balance(load, driven(load) ? driven_ : pressed, outcome);
    const bool punch_revised = revise_punch(load, outcome.forces);
    if (revise_contact() == 0 && !punch_revised && material_->settle(step_)) break;
    if (outcome.rounds == most_rounds) throw StepRefused("which points touch the wall is not settled");
  }
  require_inside();
  return outcome;
}

template <int dim>
void PressBody<dim>::place_punches(const PressLoad& load) {
  const double lower = load.moving == Punches::both ? 0.5 * load.punch_travel : displacement_[bottom_.front()];
  for (const auto d : bottom_) tried_[d] = lower;
  for (const auto d : top_) tried_[d] = lower - load.punch_travel;
}

template <int dim>
bool PressBody<dim>::revise_punch(const PressLoad& load, const PressForces& forces) {
  if (load.pressure) return false;
  const double little = 10 * settings_.tolerance * std::max(tried_scale_, largest_scale_);
  const double travel = tried_[bottom_.front()] - tried_[top_.front()];
  const bool touches = punch_closed_ ? forces.punch >= -little : travel < load.punch_travel - 1e-12 * height_;
  if (touches == punch_closed_) return false;
  punch_closed_ = touches;
  if (touches) place_punches(load);
  return true;
}

template <int dim>
void PressBody<dim>::require_inside() const {
  const std::size_t n = material_->state_size();
  std::string found;
  for (std::size_t k = 0; k < weight_.size() && found.empty(); ++k)
    found = material_->outside(std::span(tried_state_).subspan(n * k, n), tried_temperature_);
  if (sum(found.empty() ? 0 : 1, comm_) > 0)
    throw RunError(found.empty() ? "a point of another rank leaves what the material holds for" : found);
}

template <int dim>
void PressBody<dim>::agreed(const std::function<void()>& work) const {
  std::string refused;
  try {
    work();
  } catch (const StepRefused& error) {
    refused = error.what();
  }
  if (sum(refused.empty() ? 0 : 1, comm_) > 0)
    throw StepRefused(refused.empty() ? "a point of another rank refuses the step" : refused);
}

template <int dim>
void PressBody<dim>::balance(const PressLoad& load, const dealii::AffineConstraints<double>& constraints,
                             PressOutcome& outcome) {
  double scale = 0, first = 0;
  try {
    scale = assemble(load, constraints, outcome);
  } catch (const StepRefused&) {
    // A guess that no point can follow: begin from rest instead.
    if (outcome.rounds > 1 || last_step_ == 0 || driven(load)) throw;
    tried_ = displacement_;
    scale = assemble(load, constraints, outcome);
  }
  for (int iteration = 0;; ++iteration) {
    const double residual = residual_.l2_norm();
    if (iteration == 0) first = residual;
    if (!std::isfinite(residual)) throw StepRefused("forces of the body are no longer finite");
    const double balanced = settings_.tolerance * std::max(scale, largest_scale_);
    tried_scale_ = scale;
    if (residual <= balanced) return;
    if (settings_.friction > 0 && outcome.rounds == 1 && iteration >= 1 && iteration <= iterations_that_choose)
      if (choose_shear(outcome, iteration == 1)) scale = assemble(load, constraints, outcome);
    if (iteration == settings_.most_iterations || residual > 1e6 * (first + scale))
      throw StepRefused("Newton's method does not find balanced forces");
    solver_.solve(matrix_, change_, residual_, 1e-3);
    ++outcome.iterations;
    dealii::Vector<double> change(change_);  // of all ranks
    constraints.distribute(change);
    // The way along the change: less of it where its forces have turned, as when friction changes its direction.
    const double drive = change_ * residual_;
    const dealii::Vector<double> from = tried_;
    double low = 0, high = 1, low_drive = drive, way = 1;
    tried_.add(-1, change);
    for (int look = 0;; ++look) {
      try {
        scale = assemble(load, constraints, outcome);
      } catch (const StepRefused&) {
        if (look == most_looks) throw;
        high = way, way = 0.5 * (low + high);
        tried_ = from;
        tried_.add(-way, change);
        continue;
      }
      const double now = change_ * residual_;
      if (std::abs(now) <= 0.8 * std::abs(drive) || residual_.l2_norm() <= balanced || look == most_looks) break;
      if (now > 0) {
        if (way == 1) break;  // further than a Newton step it does not go
        low = way, low_drive = now;
        way = 0.5 * (low + high);
      } else {
        high = way;
        way = low + std::clamp(low_drive / (low_drive - now), 0.1, 0.5) * (high - low);
      }
      tried_ = from;
      tried_.add(-way, change);
    }
  }
}

template <int dim>
double PressBody<dim>::deepest() const {
  double most = 0;
  for (std::size_t k = 0; k < closed_.size(); ++k)
    if (closed_[k]) most = std::max(most, depth_[k]);
  return dealii::Utilities::MPI::max(most, comm_);
}

template <int dim>
bool PressBody<dim>::choose_shear(const PressOutcome& outcome, bool anew) {
  const double slip = dealii::Utilities::MPI::max(outcome.largest_slip, comm_);
  const double most = settings_.friction * settings_.wall_stiffness * deepest();
  const double before = shear_;
  if (slip > 0 && most > 0) shear_ = std::min(anew ? settings_.wall_stiffness : shear_, most / (held_share * slip));
  return shear_ != before;
}

template <int dim>
int PressBody<dim>::revise_contact() {
  const double most = deepest();
  int changes = 0;
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const bool now = covered_[k] && (closed_[k] ? depth_[k] >= -1e-4 * most : depth_[k] > 1e-4 * most);
    changes += now != bool(closed_[k]);
    closed_[k] = now;
  }
  return dealii::Utilities::MPI::sum(changes, comm_);
}

template <int dim>
double PressBody<dim>::assemble(const PressLoad& load, const dealii::AffineConstraints<double>& constraints,
                                PressOutcome& outcome) {
  agreed([&] { move_points(load, tried_); });
  matrix_ = 0;
  residual_ = 0;
  double within = 0;
  outcome.forces = {};
  outcome.dissipated = outcome.stored = outcome.thermal = outcome.slid = outcome.largest_slip = 0;
  const Sink add = [&](const dealii::FullMatrix<double>& k, const dealii::Vector<double>& f, const Dofs& dofs) {
    constraints.distribute_local_to_global(k, f, dofs, matrix_, residual_);
  };
  visit_elements(outcome.forces, within, add);
  visit_wall(load, tried_, outcome, add);
  for (std::size_t k = 0; k < answer_.size(); ++k) {
    const double volume = weight_[k] * motion_[k].volume_after;
    outcome.dissipated += volume * answer_[k].dissipated;
    outcome.stored += volume * answer_[k].stored;
    outcome.thermal += volume * answer_[k].thermal;
  }
  if (load.pressure && dealii::Utilities::MPI::this_mpi_process(comm_) == 0) {
    dealii::Vector<double> force(1);
    force[0] = *load.pressure * area_ * (load.moving == Punches::both ? 2 : 1);
    constraints.distribute_local_to_global(force, Dofs{top_.front()}, residual_);
  }
  matrix_.compress(dealii::VectorOperation::add);
  residual_.compress(dealii::VectorOperation::add);
  for (double* x :
       {&outcome.forces.punch, &outcome.forces.bottom, &outcome.forces.wall_pressure, &outcome.forces.wall_friction,
        &outcome.dissipated, &outcome.stored, &outcome.thermal, &outcome.slid, &within})
    *x = sum(*x, comm_);
  return std::sqrt(within) + (load.pressure ? *load.pressure * area_ : 0.0);
}

template <int dim>
void PressBody<dim>::accept() {
  material_->accept();
  for (PointMotion& m : motion_) {
    m.turned = turned_after(m);
    m.before = m.after;
    m.volume_before = m.volume_after;
  }
  before_ = displacement_;
  displacement_ = tried_;
  state_ = tried_state_;
  friction_ = tried_friction_;
  accepted_closed_ = closed_;
  accepted_punch_closed_ = punch_closed_;
  largest_scale_ = std::max(largest_scale_, tried_scale_);
  temperature_ = tried_temperature_;
  last_step_ = tried_step_;
}

template <int dim>
void PressBody<dim>::forces_of(const PressLoad& load, const dealii::Vector<double>& displacement,
                               dealii::Vector<double>& forces, dealii::FullMatrix<double>& tangent) {
  move_points(load, displacement);
  forces.reinit(dofs_.n_dofs());
  tangent.reinit(dofs_.n_dofs(), dofs_.n_dofs());
  const Sink add = [&](const dealii::FullMatrix<double>& k, const dealii::Vector<double>& f, const Dofs& dofs) {
    forces.add(dofs, f);
    for (unsigned i = 0; i < dofs.size(); ++i)
      for (unsigned j = 0; j < dofs.size(); ++j) tangent(dofs[i], dofs[j]) += k(i, j);
  };
  PressOutcome outcome;
  double within = 0;
  visit_elements(outcome.forces, within, add);
  visit_wall(load, displacement, outcome, add);
}

template class PressBody<2>;
template class PressBody<3>;

}  // namespace densify::fem
