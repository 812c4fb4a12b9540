#include "dem/io/scene_cell.h"

#include <cmath>

namespace densify::dem {

namespace {

struct Given {
  std::array<double, 6> value;
  Given() { value.fill(unset); }
  bool any() const {
    for (const double v : value)
      if (!std::isnan(v)) return true;
    return false;
  }
};

Given read_components(Section& stage, const char* key, Dimension dimension, const char* meaning, const char* normal,
                      const char* shear) {
  Given given;
  stage.section(key, Need::optional, meaning, [&](Section& below) {
    for (std::size_t c = 0; c < 6; ++c)
      below.quantity(tensor_names[c], given.value[c], dimension, Range::any(), Need::optional, c < 3 ? normal : shear);
    if (!below.documenting() && !given.any())
      below.fail("", std::string("gives no component; give at least one of xx, yy, zz, xy, xz, yz, or remove ") + key);
  });
  return given;
}

}  // namespace

void CellPathReader::start(double pressure) {
  if (!periodic_ || !path_.stages.empty() || pressure == 0) return;
  driven_ = true;
  for (std::size_t c = 0; c < 6; ++c) now_[c] = {CellControl::stress, c < 3 ? -pressure : 0.0};
  path_.start = now_;
}

void CellPathReader::read_stage(Section& stage, double pressure) {
  const Given stress = read_components(stage, "stress", dim::pressure,
                                       "periodic: stress that drives the cell, at the end of the stage; a component "
                                       "stays driven as it is until another stage names it",
                                       "tension positive", "sigma_ij = sigma_ji");
  const Given rate = read_components(stage, "strain_rate", dim::rate,
                                     "periodic: rate that drives the cell, at the end of the stage; 0 1/s until a "
                                     "stage drives the component",
                                     "dv_i/dx_i, extension positive", "dv_i/dx_j, twice the shear strain rate");
  if (stage.documenting()) return;
  const bool squeezed = periodic_ && !std::isnan(pressure);
  if (!periodic_)
    for (const char* key : {"stress", "strain_rate"})
      if (stage.has(key))
        stage.fail(key, "drives a periodic cell, which this specimen is not; use shape = \"periodic\", or remove it");
  for (std::size_t c = 0; c < 6; ++c) {
    const std::string name = tensor_names[c];
    const bool by_stress = !std::isnan(stress.value[c]), by_rate = !std::isnan(rate.value[c]);
    if (by_stress && by_rate)
      stage.fail("strain_rate", "and stress both drive " + name + "; remove it from one of them");
    if (squeezed && (by_stress || by_rate))
      stage.fail("pressure", "drives all six components, and " + std::string(by_stress ? "stress" : "strain_rate") +
                                 " drives " + name + " too; remove one of them, or give stress.xx, yy and zz instead");
    if (by_stress) now_[c] = {CellControl::stress, stress.value[c]};
    if (by_rate) now_[c] = {CellControl::rate, rate.value[c]};
    if (squeezed) now_[c] = {CellControl::stress, c < 3 ? -pressure : 0.0};
    driven_ = driven_ || by_stress || by_rate || squeezed;
  }
  path_.stages.push_back(now_);
}

}  // namespace densify::dem
