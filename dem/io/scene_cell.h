#pragma once
// What the stages of a process say of a periodic cell: stress, strain_rate, pressure.

#include "dem/io/scene_parts.h"

namespace densify::dem {

/// Collects the goals of the six components, stage by stage.
class CellPathReader {
 public:
  explicit CellPathReader(ContainerShape shape) : periodic_(shape == ContainerShape::periodic) {}

  /// A pressure that drives the cell from the start, none if 0; after the first stage a call does nothing [Pa].
  void start(double pressure);
  /// Declares and reads the keys of a stage; `pressure` is that which it gives, NaN if none [Pa].  Throws InputError at
  /// a component that is driven twice, and where there is no cell.
  void read_stage(Section& stage, double pressure);
  /// Nothing when no stage drives the cell.
  std::optional<CellPath> path() const { return driven_ ? std::optional(path_) : std::nullopt; }

 private:
  bool periodic_, driven_ = false;
  CellPath path_;
  CellGoals now_;
};

}  // namespace densify::dem
