#pragma once
// The tables of densify moduli: one row a moment and contact model.

#include "app/result_table.h"
#include "dem/network/moduli.h"

namespace densify::app {

/// Columns of a moment and its network.
std::vector<ResultTable::Cell> moment_cells(const dem::SpecimenNetwork&, const dem::NetworkStructure&);
/// Columns of a tensor: isotropic parts, 21 constants relaxed and affine, checks.
std::vector<ResultTable::Cell> stiffness_cells(const dem::TensorAnswer&);
std::vector<ResultTable::Cell> viscosity_cells(const dem::ViscousAnswer&);

}  // namespace densify::app
