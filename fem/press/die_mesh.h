#pragma once
// The mesh of a cylinder in a die: a half section of revolution, or a quarter of the cylinder.

#include <deal.II/distributed/shared_tria.h>

namespace densify::fem {

struct CylinderSize {
  double radius, height;  ///< of the unloaded body [m]
  int radial, axial;      ///< elements over the radius (3D: nearly) and over the height
  double bore = 0;        ///< radius of a hole along the axis, for verification in two dimensions [m]
};

/// Parts of the surface.
enum Face : dealii::types::boundary_id { bottom = 0, top = 1, wall = 2, symmetry_x = 3, symmetry_y = 4, hole = 5 };

/// Elements of the mesh that make_cylinder() makes.
int element_count(const CylinderSize&, int dim);

/// dim = 2: (r, z) in [bore, radius] x [0, height], the axis being `symmetry_x`.  dim = 3: x, y >= 0, z the axis;
/// `radial` rounded to a power of two times two.  Lateral faces lie on the cylinder.
template <int dim>
void make_cylinder(dealii::Triangulation<dim>&, const CylinderSize&);

}  // namespace densify::fem
