#include "fem/press/die_mesh.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/manifold_lib.h>
#include <deal.II/grid/tria.h>

#include <cmath>

namespace densify::fem {

namespace {

/// Of a quarter of a disc whose coarsest mesh has three elements, two over the radius.
int refinements(const CylinderSize& size) {
  return std::max(0, int(std::lround(std::log2(size.radial / 2.0))));
}

template <int dim>
void mark_faces(dealii::Triangulation<dim>& mesh, const CylinderSize& size) {
  const double small = 1e-8 * std::min(size.radius, size.height);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const auto c = face->center();
      Face id = wall;
      if (c[dim - 1] < small)
        id = bottom;
      else if (c[dim - 1] > size.height - small)
        id = top;
      else if (std::abs(c[0]) < small)
        id = symmetry_x;
      else if (dim == 2 && c[0] < size.bore + small)
        id = hole;
      else if (dim == 3 && std::abs(c[1]) < small)
        id = symmetry_y;
      face->set_boundary_id(id);
    }
}

}  // namespace

int element_count(const CylinderSize& size, int dim) {
  return size.axial * (dim == 2 ? size.radial : 3 << (2 * refinements(size)));
}

template <>
void make_cylinder(dealii::Triangulation<2>& mesh, const CylinderSize& size) {
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {unsigned(size.radial), unsigned(size.axial)}, {size.bore, 0},
                                                    {size.radius, size.height});
  mark_faces(mesh, size);
}

template <>
void make_cylinder(dealii::Triangulation<3>& mesh, const CylinderSize& size) {
  dealii::Triangulation<2> disc, flat;
  dealii::GridGenerator::quarter_hyper_ball(disc, dealii::Point<2>(), size.radius);
  disc.refine_global(unsigned(refinements(size)));
  dealii::GridGenerator::flatten_triangulation(disc, flat);
  dealii::GridGenerator::extrude_triangulation(flat, unsigned(size.axial) + 1, size.height, mesh);
  mark_faces(mesh, size);
  mesh.reset_all_manifolds();
  mesh.set_all_manifold_ids(dealii::numbers::flat_manifold_id);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == wall) face->set_all_manifold_ids(1);
  mesh.set_manifold(1, dealii::CylindricalManifold<3>(2));
}

}  // namespace densify::fem
