#include "fem/voxel_element.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <Eigen/LU>

namespace densify::fem {

ElementMatrix element_matrix(const Mat3& edges, const ElasticSolid& solid) {
  const double e = solid.youngs_modulus, nu = solid.poissons_ratio;
  const double lambda = e * nu / ((1 + nu) * (1 - 2 * nu)), mu = e / (2 * (1 + nu));
  // The same about the other side of the origin, so that left-handed edges make a cell that deal.II can have.
  const double side = edges.determinant() < 0 ? -1 : 1;
  dealii::Point<3> corners[3];
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) corners[k][c] = side * edges(c, k);
  dealii::Triangulation<3> one;
  dealii::GridGenerator::parallelepiped(one, corners);
  const dealii::FESystem<3> fe(dealii::FE_Q<3>(1), 3);
  dealii::DoFHandler<3> dofs(one);
  dofs.distribute_dofs(fe);
  dealii::FEValues<3> values(fe, dealii::QGauss<3>(2), dealii::update_gradients | dealii::update_JxW_values);
  values.reinit(dofs.begin_active());
  const dealii::FEValuesExtractors::Vector displacement(0);
  ElementMatrix k = ElementMatrix::Zero();
  for (unsigned q = 0; q < values.n_quadrature_points; ++q)
    for (unsigned i = 0; i < 24; ++i)
      for (unsigned j = 0; j < 24; ++j)
        k(i, j) +=
            values.JxW(q) *
            (lambda * values[displacement].divergence(i, q) * values[displacement].divergence(j, q) +
             2 * mu * values[displacement].symmetric_gradient(i, q) * values[displacement].symmetric_gradient(j, q));
  return k;
}

Mat3 unit_strain(int k) {
  Mat3 e = Mat3::Zero();
  if (k < 3) {
    e(k, k) = 1;
  } else {
    const int a = k == 3 ? 1 : 0, b = k == 5 ? 1 : 2;
    e(a, b) = e(b, a) = 0.5;
  }
  return e;
}

ElementProbes element_probes(const Mat3& edges) {
  ElementProbes p;
  for (int k = 0; k < 6; ++k)
    for (int v = 0; v < 8; ++v)
      p.block<3, 1>(3 * v, k) = unit_strain(k) * (edges * Vec3(v & 1, v >> 1 & 1, v >> 2 & 1));
  return p;
}

}  // namespace densify::fem
