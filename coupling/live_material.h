#pragma once
// A material whose every finite element owns a volume element of particles.

#include <mpi.h>

#include <memory>

#include "coupling/live_rve.h"
#include "fem/press/point_material.h"

namespace densify::coupling {

/// One packing in all elements, or each its own.
enum class ElementSeeds { one, each };

struct LiveSettings {
  ElementSeeds seeds = ElementSeeds::one;
  double tolerance = 1e-3;  ///< stress of a volume element off that of its law, over the largest stress so far
};

/// What the volume elements have done by now, of all ranks.
struct LiveCount {
  std::uint64_t elements = 0, steps = 0, solutions = 0;  ///< steps and linear systems of particles, tried ones too
  std::uint64_t rounds = 0;                              ///< solutions of the finite elements, one a step at least
  std::uint64_t bytes = 0;
  double largest_mismatch = 0;  ///< of stresses with which a step was accepted, over the largest stress then
  double mismatch_work = 0, contact_work = 0;  ///< sums of LiveRve's over accepted steps [J]
  double dropped_stress = 0;  ///< largest shear but rz, which a body of revolution cannot have, over the largest stress
};

/// What the steps to come depend on besides the body.
struct LiveMemory {
  std::vector<std::string> images;  ///< of the volume elements of all ranks
  double largest_stress = 0;        ///< [Pa]
  LiveCount count;
};

/// Over one solution of the finite elements each volume element stands for an affine law sigma = sigma_0 + C (strain -
/// strain_0), the same at all points of its finite element: that of its step with the strain foretold.  Then it makes
/// the step with the mean strain of its points; where its stress is off the law's by more than the tolerance, it gives
/// a new law and the finite elements are solved again.  The body's stress is that of the rate at the end of the step,
/// as the mean rates of this step and of the one before foretell it (BDF2): sigma + share C (strain - carried strain).
/// Relative density is the volume of the solid at its temperature over that of the body.  State: relative density,
/// growth of the solid's volume since the start.
class LiveMaterial : public fem::PointMaterial {
 public:
  /// For finite elements of so many points each, given to the ranks in their order, of `elements` in all.  Packs and
  /// presses the powder to the process' start_pressure.  Collective.  Throws InputError.
  LiveMaterial(const dem::Scene&, const LiveSettings&, std::size_t elements, std::size_t points_of_element, MPI_Comm);

  double mean_density() const;  ///< at the start, of all

  std::size_t state_size() const override { return 2; }
  void begin(double, std::span<double> states) const override;
  double density(std::span<const double> state) const override { return state[0]; }
  double solid_volume(std::span<const double> state, double, double) const override { return state[1]; }
  void update(std::span<const fem::PointStep>, std::span<const double> before, std::span<double> after,
              std::span<fem::PointAnswer>) const override;
  bool affine() const override { return true; }
  void begin_step(std::span<const fem::PointStep> guess) override;
  bool settle(std::span<const fem::PointStep>) override;
  void accept() override;
  double resolution() const override;  ///< the tolerance as a change of volume, in the softest element

  LiveCount count() const;                                                   ///< collective
  const LiveRve& element(std::size_t own) const { return *elements_[own]; }  ///< of this rank

  LiveMemory memory() const;  ///< images on the first rank only; collective
  /// Throws FileError for what is not of these elements.
  void restore(const LiveMemory&);

 private:
  struct Law {
    Vec6 stress, strain;
    Mat6 tangent;
    LiveRve::Carried carried;
  };
  Vec6 mean_strain(std::span<const fem::PointStep>, std::size_t own) const;
  /// Calls work(own) for the elements of this rank; a RunError of any of them refuses the step on all ranks.
  template <class Work>
  void in_each(const Work&);

  const LiveSettings settings_;
  const std::size_t all_, points_;
  const MPI_Comm comm_;
  std::size_t first_ = 0;  // of this rank's elements
  std::vector<std::unique_ptr<LiveRve>> elements_;
  std::vector<Law> law_;
  std::vector<double> growth_start_, growth_, growth_now_;  // of the solids, over the reference; accepted, tried
  double largest_stress_ = 0, tried_largest_ = 0;           // [Pa]
  int rounds_of_step_ = 0;
  double tried_mismatch_ = 0;
  LiveCount before_;  // of the run that this one goes on from
  LiveCount own_;     // of accepted steps, of this rank
};

}  // namespace densify::coupling
