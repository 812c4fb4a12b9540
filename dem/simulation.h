#pragma once
// One RVE in time: the state, its environment, and the step.  No files, no clock, no global state: hundreds of these
// live side by side in one process.

#include <limits>
#include <optional>

#include "base/schedule.h"
#include "dem/boundary/cell_drive.h"
#include "dem/boundary/punch.h"
#include "dem/integrate/guards.h"
#include "dem/integrate/inertia.h"
#include "dem/integrate/inertia_free.h"
#include "dem/integrate/leapfrog.h"
#include "dem/integrate/step_control.h"
#include "dem/integrate/time_step.h"
#include "dem/measure/local_density.h"

namespace densify::dem {

enum class ContainerShape : std::uint8_t { free, cylinder, box, periodic };

/// What holds the powder.
struct Container {
  ContainerShape shape = ContainerShape::free;
  Vec3 size = Vec3::Zero();   ///< cylinder: (diameter, diameter, height); box: edges [m]
  bool punch = true;          ///< cylinder and box: a load-controlled punch on top
  double wall_expansion = 0;  ///< linear thermal expansion of the lateral walls [1/K]
  WallMaterial material;
  PunchSettings punch_settings;
};

/// A force on one particle, reached linearly over `ramp`.
struct Load {
  std::uint32_t particle = 0;  ///< number as listed in the specimen, from 0
  Vec3 force = Vec3::Zero();   ///< [N]
  double ramp = 0;             ///< [s]
};

struct IntegrationSettings {
  IntegrationMethod method = IntegrationMethod::leapfrog;
  double accuracy = unset;  ///< numerical error of the relative density that is wanted; see choose_settings
  InertiaFreeSettings inertia_free;
  StepRule rule = StepRule::particle_sum;
  double step_safety = 0.8;
  Inertia inertia = Inertia::uniform;
  double fixed_step = unset;       ///< replaces the rule; with equalised inertia the step dt* of the whole run [s]
  double largest_step = unset;     ///< [s]
  double smallest_step = unset;    ///< of the step control [s]; unset: largest_step / 160
  double inertia_measure = unset;  ///< inertial number that the step control of equalised inertia keeps
  double load_steps = 2000;        ///< StepControl::load_steps
  int limit_interval = 20;         ///< steps between two evaluations of the limit
  double mass_scaling = 1;         ///< alpha_m (4.80)
  double skin = 0.2;               ///< reach of the neighbour list over the mean radius
  double drag = 0;                 ///< mass-proportional damping rate [1/s], for packing
  Vec3 gravity = Vec3::Zero();     ///< [m/s^2]
  int threads = 1;
  GuardSettings guards;
};

/// Everything a simulation is made from.
struct Setup {
  std::vector<Material> materials;
  std::vector<Interface> interfaces;
  ContactModel contact;
  Container container;
  IntegrationSettings integration;
  Schedule schedule;
  std::vector<Load> loads;
  double reference_temperature = 293.15;   ///< at which radii and densities are given [K]
  Particles particles;                     ///< reference_radius, material, id, body.position set
  Cell cell;                               ///< periodic only
  std::optional<CellPath> cell_path = {};  ///< periodic only: what drives the cell through the stages of the schedule
  bool energies = false;                   ///< of a driven cell, in the history
};

/// All that changes; written to a checkpoint bit for bit.
struct State {
  Particles particles;
  Cell cell;
  ContactList contacts;
  Walls walls;
  Punch punch;
  std::vector<double> expansion;  ///< r(T)/r_ref of each material
  double temperature = unset;     ///< at which radii and rows are evaluated [K]
  double time = 0;                ///< process time t^n [s]
  double last_step = 0;           ///< t^n - t^{n-1} [s]
  double stable_step = 0;         ///< safety x critical of the last evaluation [s]
  double critical_step = 0;       ///< [s]
  std::uint64_t steps = 0;
  bool inertia_free = false;         ///< moves without inertia by now, masses are real
  std::vector<double> active_since;  ///< of each pair of materials [s]
  ControlState control;              ///< equalised inertia only
  CellDrive cell_drive;              ///< a cell with a path only
  LocalDensity local_density;        ///< with pore closure only
};

/// What a measure reads after a recorded pass.
struct Recording {
  std::vector<ContactRecord> contact;
  std::vector<WallRecord> wall;
};

/// The limits of the step control that a scene's integration leaves open.
StepControl step_control(const IntegrationSettings&, const Schedule&);

/// Sets equalised inertia and the settings of its step control for a wanted bias of the relative density, by what was
/// measured in hot pressing (doc/accuracy.md); the noise of one trajectory is not in it.
void choose_settings(IntegrationSettings&, double accuracy);

class Simulation {
 public:
  /// Throws InputError when the setup is inconsistent (missing property, particle outside its container, ...).
  explicit Simulation(Setup setup);

  /// What comes before the forces of a step: environment and neighbour lists at the present time.  `evaluate` does it;
  /// who calls it before can tell the time of lists from that of forces.
  void refresh();
  /// First half of a step: environment, lists and forces at the present time.  With `record` given it also fills it;
  /// the trajectory is the same with and without.  Once a step, since histories advance: a second call before `move`
  /// throws std::logic_error.  Throws RunError when the state is no longer sound.
  void evaluate(Recording* record);
  /// Second half of a step: chooses its length and moves particles, punch and cell.  Needs `evaluate` before.
  void move() { move(nullptr); }
  /// Strains the cell at a constant rate up to a process time, in as many steps without inertia as the error of each
  /// asks for, and says what it answered.  Needs a periodic cell that nothing else drives, without inertia from the
  /// start, else throws std::logic_error.
  CellAnswer strain(CellStretch);
  /// How the answer of strain(), just called, changes with the rate; once.
  CellTangent strain_tangent() { return inertia_free_.tangent(state_, setup_, state_.time - strained_from_); }
  /// Velocities against the cell at the end of strain() [m/s].
  const Eigen::VectorXd& strain_velocities() const { return inertia_free_.velocity(); }
  /// One step, or the rest of it after an `evaluate`.
  void advance(Recording* record = nullptr) {
    if (!evaluated_) evaluate(record);
    move();
  }

  /// Limit of the step in the present state [s], before the safety factor.
  StepLimit step_limit();
  /// Throws InputError when a fixed step is above the present limit, or when the schedule takes more steps than any
  /// computer will do.
  void require_stable_step();

  bool equalised() const { return setup_.integration.inertia == Inertia::equalised && !state_.inertia_free; }
  bool finished() const { return state_.time >= setup_.schedule.end(); }
  /// True when every neck of a packing that has necks is at equilibrium.
  bool all_at_equilibrium() const;

  const Setup& setup() const { return setup_; }
  const State& state() const { return state_; }
  const PairTable& table() const { return table_; }
  /// Replaces the state by a checkpoint's.
  void restore(State state);
  /// Whoever changes the state breaks its balance of energy, so that the guards begin anew.
  State& mutable_state() {
    guards_.forget();
    may_have_travelled_ = std::numeric_limits<double>::infinity();
    return state_;
  }
  /// Throws RunError when the state is not sound, between two looks of the guards: before it is written anywhere.
  void require_sound() { guards_.require_sound(guard_view()); }
  const Guards& guards() const { return guards_; }
  void resume_guards(double last_look) { guards_.resume(last_look); }
  void set_gravity(const Vec3& g) { setup_.integration.gravity = g; }

  double temperature() const { return setup_.schedule.temperature(state_.time); }
  /// On the punch, or what drives a cell: the mean of its three normal stresses, NaN while a rate drives one of them
  /// [Pa].
  double pressure() const;
  /// True for a periodic cell of which a stress drives a component, at some time of the process.
  bool stress_driven() const { return setup_.cell_path && setup_.cell_path->by_stress(); }
  /// Of the contacts in the last evaluation, symmetrised, tension positive; only of a stress-driven cell [Pa].
  const Mat3& cell_stress() const { return cell_stress_; }
  /// The pores as the contacts of the last evaluation met them; without density where they do not resist.
  PoreClosure pores() const;
  /// The load of the process now.
  ProcessLoad load() const;
  /// The largest pressure, or stress that drives the cell, of the whole process [Pa].
  double peak_load() const;
  /// What drives a component of the cell now, in the order of tensor_places.
  CellGoal cell_goal(std::size_t component) const;
  double real_mass(std::size_t p) const;  ///< [kg]
  /// Solid volume of the powder at the reference temperature [m^3].
  double solid_volume() const;
  /// Index of a wall by name; no value when the container has none of that name.
  std::optional<std::size_t> wall(std::string_view name) const;
  /// Present area under the punch, the hot one in an expanding die; 0 without lateral walls [m^2].
  double punch_area() const;
  std::size_t bytes() const;  ///< memory of state and scratch
  const InertiaFreeCount& inertia_free_count() const { return inertia_free_.count(); }
  std::size_t contacts_now() const;                                        ///< touching or necked pairs
  std::size_t near_pairs() const { return pass_.near().places().size(); }  ///< that a pass visits

 private:
  void move(const CellStretch*);
  void set_environment();
  void keep_list_fresh();
  void measure_pores();
  void compute_forces(Recording* record);
  double choose_step();
  [[noreturn]] void refuse_idle_step(double step) const;
  bool moves_without_inertia() const;
  void drop_inertia();
  double leapfrog_step();
  void plan_equalised_step();
  void equalise_inertia();
  void equalise_punch();
  Column column() const;
  void weigh_cell(CellStiffness, double step);
  double cell_share() const;
  CellStiffness equalised_cell_stiffness() const;
  double cell_leap() const;
  void drive_cell(LeapfrogSteps);
  void rebuild_lists();
  void prune_near(double list_age);
  void set_list_slack(double list_age);
  void note_travel(double fastest, double step);
  GuardView guard_view();

  Setup setup_;
  PairTable table_;
  ForcePass pass_;
  InertiaFree inertia_free_;
  State state_;
  Guards guards_;
  bool refreshed_ = false;          // between refresh() and move()
  bool evaluated_ = false;          // between evaluate() and move()
  bool table_unsettled_ = true;     // the table changes at the next step even at constant temperature
  double touching_volume_ = unset;  // of a driven cell when particles touched last [m^3]
  StepStiffness stiffness_;         // equalised inertia only: of the last pass
  StepControl control_;
  double column_mass_ = 0;  // equalised inertia only: of the column's uniform compaction [kg]
  // How far surfaces may have approached since the last pruning, from above, and what the list still allows [m].
  double may_have_travelled_ = 0, list_slack_ = 0;
  std::vector<double> expansion_step_;
  std::optional<std::size_t> punch_wall_;
  double strained_from_ = 0;  // process time at which the last strain() began [s]
  Mat3 cell_stress_ = Mat3::Zero();
  double pore_scale_ = 1;  // PoreClosure::scale
};

}  // namespace densify::dem
