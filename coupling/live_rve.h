#pragma once
// A volume element that somebody else moves: a periodic cell of particles that is strained step by step, tries a step
// as often as it is asked to, and goes on only when the step stands.

#include <string>

#include "dem/io/scene.h"
#include "dem/powder/compaction.h"
#include "dem/simulation.h"

namespace densify::coupling {

/// The powder of a scene in its cell, packed with the given seed and pressed along z to `pressure` [Pa], as in a die,
/// so that its particles carry: loose ones have no stress to answer with.  Throws InputError for a powder that cannot
/// be packed or a scene that cannot be moved by an owner, RunError when pressing fails.
dem::GreenBody pressed_powder(const dem::Scene&, std::uint64_t seed, double pressure);

class LiveRve {
 public:
  /// Of a scene's powder, pressed.
  LiveRve(const dem::Scene&, const dem::GreenBody&);

  /// Stress [Pa] at the end of the step to a process time from the accepted state, with a logarithmic strain in a frame
  /// that turns with the element.  Throws RunError when the particles find no balance.
  Vec6 try_step(const Vec6& strain, double end);
  /// d stress/d strain of the step just tried [Pa].
  Mat6 tangent();
  /// The step tried last stands.
  void accept();

  /// The strain that the rate of the accepted step before makes until `end`, and how much further from it the rate at
  /// `end` is than that of the step: h/(h + h_before).  No share where a stage has begun and while grains are loose:
  /// they answer to strains, not to rates.
  struct Carried {
    Vec6 strain = Vec6::Zero();
    double share = 0;
  };
  Carried carried(double end) const;

  double time() const { return accepted_.time; }  ///< [s]
  double density() const;                         ///< of the accepted state: volume of the solid over that of the cell
  /// Volume of the solid at a temperature [K] over that at the reference temperature.
  double solid_growth(double temperature) const;
  /// Of the step just tried: dem::CellAnswer's power and mismatch over its length [J].
  double contact_work() const { return answer_.power * foretold_step_; }
  double mismatch_work() const { return answer_.mismatch * foretold_step_; }

  /// The accepted state, bit for bit, and back.  Throws FileError for bytes that are not one of this element.
  std::string image() const;
  void restore(const std::string& image);

  std::uint64_t steps() const { return sim_.inertia_free_count().steps; }          ///< of particles, tried ones too
  std::uint64_t solutions() const { return sim_.inertia_free_count().solutions; }  ///< of linear systems
  std::size_t bytes() const;

 private:
  dem::Simulation sim_;
  dem::State accepted_;
  dem::CellAnswer answer_;
  Vec6 rate_ = Vec6::Zero();  // of strain in the accepted step before [1/s]
  double step_ = 0;           // its length; 0: a stage has begun [s]
  // What foretells the motion of another strain over the same step; of none when empty.
  double foretold_end_ = 0, foretold_step_ = 0;
  Vec6 foretold_strain_;
  Eigen::VectorXd velocities_;
  Eigen::MatrixXd motion_;
};

}  // namespace densify::coupling
