#include <iostream>

#include "base/version.h"
#include "dem/state/cell.h"

// A cell of edges 2, 3 and 4 m has 24 m^3.
int main() {
  densify::dem::Cell cell;
  cell.h = Eigen::Vector3d(2.0, 3.0, 4.0).asDiagonal();
  std::cout << densify::version() << " " << cell.volume() << "\n";
}
