#pragma once
// The body in the die: finite elements, one step at a time.

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fem/press/die_mesh.h"
#include "fem/press/linear_solver.h"
#include "fem/press/point_force.h"
#include "fem/press/point_material.h"
#include "fem/press/press_state.h"
#include "fem/press/wall_contact.h"

namespace densify::fem {

/// Which punches come into the die: one against the other, which stands with the die, or both alike (double action).
enum class Punches { upper, both };

struct PressSettings {
  int degree = 2;             ///< of the displacements; volume changes have the degree less one (element by element)
  double wall_stiffness = 0;  ///< DieWall::stiffness [Pa/m]
  double friction = 0;        ///< Coulomb's, between body and die
  double tolerance = 3e-8;    ///< of the balance of forces, relative to those within the elements
  int most_iterations = 40;   ///< of Newton's method
  Punches punches = Punches::upper;
};

/// What is outside the body at the end of a step.
struct PressLoad {
  double step;                      ///< [s]
  double temperature;               ///< of the body, uniform [K]
  double die_radius;                ///< [m]
  double die_top;                   ///< height of the die's upper end over the lower punch [m]
  std::optional<double> pressure;   ///< of the punches on the section of the unloaded body, positive [Pa]; without it
  double punch_travel = 0;          ///< how far the punches have come together since the start [m]
  double die_rise = 0;              ///< how far the die moves up during the step [m]
  Punches moving = Punches::upper;  ///< as in the settings, or the upper one alone (ejection)
};

/// Forces at the end of a step, of the whole cylinder [N].
struct PressForces {
  double punch = 0;          ///< of the upper punch on the body, positive down
  double bottom = 0;         ///< of the lower punch, positive up
  double wall_pressure = 0;  ///< of the die, sum of the radial forces
  double wall_friction = 0;  ///< of the die, axial, positive up
};

struct PressOutcome {
  int iterations = 0;  ///< Newton's
  int rounds = 0;      ///< of points that touch the wall
  PressForces forces;
  double dissipated = 0;    ///< in the body during the step [J]
  double stored = 0;        ///< elastic energy of the body at the end [J]
  double largest_slip = 0;  ///< along the wall in the step [m]
  double thermal = 0;       ///< work on the thermal strain during the step [J]
  double slid = 0;          ///< dissipated by friction at the wall during the step [J]
};

/// What is known at a point of the body.
struct PointRecord {
  Vec3 place;      ///< r theta z (theta 0), or x y z, now [m]
  double volume;   ///< now, of the whole cylinder [m^3]
  double density;  ///< relative
  Mat3 stress;     ///< Cauchy, along those axes [Pa]
};

struct Densities {
  double mean, least, most;  ///< relative; the mean by volume
};

/// dim = 2: a body of revolution; 3: a quarter of one.  Everything is found from the displacement since the mesh was
/// made, so that volumes and mass are exact.  Displacements are of Q_degree, the volume ratio is the L2 projection of
/// det F to P_(degree-1) of each element, which does not lock where the body is nearly incompressible (Q2/P1: inf-sup
/// stable). The punches are plane and without friction.  One that is pressed stays on the body, and holds nothing when
/// its pressure has gone to zero; one that is driven by travel lets go where it would pull.  The frame is that of the
/// die, as long as the lower punch or neither moves.
template <int dim>
class PressBody {
 public:
  PressBody(const CylinderSize&, std::shared_ptr<PointMaterial>, double density, double temperature,
            const PressSettings&, MPI_Comm);

  /// Tries a step from the accepted state.  Throws StepRefused when no solution is found, RunError where the solution
  /// leaves what the material holds for.
  PressOutcome try_step(const PressLoad&);

  /// Makes the step that was tried last the accepted state.
  void accept();

  Densities densities() const;  ///< of the accepted state
  /// ln(density after/before) of every owned point of the step that was tried.
  std::vector<double> densification() const;
  double resolution() const { return material_->resolution(); }   ///< PointMaterial's; collective
  std::vector<PointRecord> points() const;                        ///< owned ones, of the step that was accepted last
  const std::vector<double>& weights() const { return weight_; }  ///< unloaded volumes of owned points [m^3]
  PressState state() const;                                       ///< the accepted one, on every rank; collective
  /// Back to a state.  Throws InputError when it is of another mesh.
  void restore(const PressState&);
  unsigned points_of_element() const { return unsigned(points_of_cell_.size()); }
  MPI_Comm comm() const { return comm_; }
  double mass() const;                                ///< volume of the solid as it was unstressed at the start [m^3]
  double volume() const;                              ///< of the body [m^3]
  double height() const;                              ///< [m]
  double unloaded_height() const { return height_; }  ///< [m]
  double section() const { return area_; }            ///< of the unloaded body, as the mesh has it [m^2]
  double lower_rise() const;                          ///< of the lower punch in the die, since the start [m]
  Punches punches() const { return settings_.punches; }
  const dealii::Vector<double>& displacement() const { return displacement_; }
  const dealii::DoFHandler<dim>& dofs() const { return dofs_; }
  const dealii::Mapping<dim>& mapping() const { return mapping_; }

  /// Internal forces less those of the wall for a displacement after a step, and their derivative [N], [N/m]; for
  /// tests, on one rank.
  void forces_of(const PressLoad&, const dealii::Vector<double>& displacement, dealii::Vector<double>& forces,
                 dealii::FullMatrix<double>& tangent);

 private:
  using Dofs = std::vector<dealii::types::global_dof_index>;
  /// Takes forces and stiffness of one element or face.
  using Sink = std::function<void(const dealii::FullMatrix<double>&, const dealii::Vector<double>&, const Dofs&)>;

  void make_constraints();
  void make_points(double density);
  /// Every owned point after the step.
  void strain_points(const PressLoad&, const dealii::Vector<double>& tried);
  /// The same, and the material answers for all at once.
  void move_points(const PressLoad&, const dealii::Vector<double>& tried);
  /// What a point of one rank refuses is refused by all; `work` throws StepRefused.
  void agreed(const std::function<void()>& work) const;
  /// Forces of the points as moved; sums of forces on the punches; forces within the elements, squared.
  void visit_elements(PressForces&, double& within, const Sink&);
  void visit_wall(const PressLoad&, const dealii::Vector<double>& tried, PressOutcome&, const Sink&);
  /// The system of one Newton iteration: residual, scale of it.
  double assemble(const PressLoad&, const dealii::AffineConstraints<double>&, PressOutcome&);
  /// Balance of forces with the points of the wall that are closed now.
  void balance(const PressLoad&, const dealii::AffineConstraints<double>&, PressOutcome&);
  /// Stiffness of the slip that friction holds: a hundredth of the largest slip of the step takes it up.
  /// Chosen anew, or only made softer; whether it changed.
  bool choose_shear(const PressOutcome&, bool anew);
  void require_inside() const;
  /// The punches hold the body at a travel.
  bool driven(const PressLoad& load) const { return !load.pressure && punch_closed_; }
  void place_punches(const PressLoad&);
  /// A driven punch lets go where it pulls, and meets a body that has come up to it; whether one did.
  bool revise_punch(const PressLoad&, const PressForces&);
  double deepest() const;  ///< of the closed points inside the wall, on all ranks [m]
  /// Opens points that the wall pulls, closes those that are inside it; how many, on all ranks.
  int revise_contact();
  Densities densities_of(const std::vector<double>& state, const std::vector<double>& volume) const;

  const MPI_Comm comm_;
  const PressSettings settings_;
  const std::shared_ptr<PointMaterial> material_;
  const double radius_, height_;  // of the unloaded body [m]
  double area_ = 0;               // of its section, as the mesh has it [m^2]
  dealii::parallel::shared::Triangulation<dim> mesh_;
  const dealii::FESystem<dim> element_;
  const dealii::MappingQ<dim> mapping_;
  const dealii::QGauss<dim> points_of_cell_;
  const dealii::QGauss<dim - 1> points_of_face_;
  dealii::DoFHandler<dim> dofs_;
  dealii::AffineConstraints<double> pressed_, both_, driven_;  // upper punch by pressure, both, held at a travel
  Dofs top_, bottom_;                                          // axial ones; all of the top follow the first
  std::vector<char> punch_;                                    // of each: 1 top, 2 bottom, 0 else
  dealii::PETScWrappers::MPI::SparseMatrix matrix_;
  dealii::PETScWrappers::MPI::Vector residual_, change_;
  LinearSolver solver_;

  double start_temperature_, temperature_, tried_temperature_ = 0, last_step_ = 0, tried_step_ = 0;
  dealii::Vector<double> displacement_, before_, tried_;  // [m]; before_: one accepted step earlier
  std::vector<double> weight_;                            // unloaded volume of an owned point [m^3]
  std::vector<PointMotion> motion_;                       // of an owned point over the step that is tried
  std::vector<PointStep> step_;
  std::vector<PointAnswer> answer_;
  std::vector<double> state_, tried_state_;
  std::vector<Vec3> friction_, tried_friction_;              // of an owned point of the wall [Pa]
  double largest_scale_ = 0, tried_scale_ = 0;               // of forces within the elements so far [N]
  double shear_ = 0;                                         // DieWall::shear of this step [Pa/m]
  std::vector<char> closed_, accepted_closed_;               // it touches the wall
  std::vector<char> covered_;                                // it is below the die's upper end
  std::vector<double> depth_;                                // inside the wall [m]
  bool punch_closed_ = true, accepted_punch_closed_ = true;  // a driven punch touches the body
};

extern template class PressBody<2>;
extern template class PressBody<3>;

}  // namespace densify::fem
