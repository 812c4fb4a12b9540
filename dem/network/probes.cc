#include "dem/network/probes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "base/check.h"
#include "dem/network/elimination.h"
#include "dem/network/multigrid.h"

namespace densify::dem {

namespace {

constexpr int row_of[6] = {0, 1, 2, 1, 0, 0}, column_of[6] = {0, 1, 2, 2, 2, 1};

Mat3 unit_rate(int k) {
  Mat3 rate = Mat3::Zero();
  rate(row_of[k], column_of[k]) += 0.5;
  rate(column_of[k], row_of[k]) += 0.5;
  return rate;
}

Vec6 stress_of(const Vec3& force, const Vec3& branch) {
  Vec6 s;
  for (int k = 0; k < 6; ++k)
    s[k] = 0.5 * (force[row_of[k]] * branch[column_of[k]] + force[column_of[k]] * branch[row_of[k]]);
  return s;
}

/// Stiffness of an edge and what it sees of its ends; rotations are measured by the arc at a distance `length`, so that
/// all unknowns are lengths.
template <int B>
struct EdgeMatrices {
  using End = Eigen::Matrix<double, 3, B>;
  Mat3 stiffness, turning = Mat3::Zero();
  End i, j = End::Zero();                          // opening of the contact by the motion of each end
  End turn_i = End::Zero(), turn_j = End::Zero();  // relative rotation

  EdgeMatrices(const NetworkEdge& e, const EdgeLaw& law, double length) {
    const Mat3 along = e.normal * e.normal.transpose(), across = Mat3::Identity() - along;
    stiffness = law.coefficient * along + law.lateral * across;
    i = End::Zero();
    i.template leftCols<3>() = -Mat3::Identity();
    if (!e.at_wall) j.template leftCols<3>().setIdentity();
    if constexpr (B == 6) {
      turning = (law.torsion * along + law.bending * across) / (length * length);
      Mat3 turned;  // n x
      turned << 0, -e.normal[2], e.normal[1], e.normal[2], 0, -e.normal[0], -e.normal[1], e.normal[0], 0;
      i.template rightCols<3>() = e.lever / length * turned;
      turn_i.template rightCols<3>() = -Mat3::Identity();
      if (e.at_wall) return;
      j.template rightCols<3>() = (e.branch.norm() - e.lever) / length * turned;
      turn_j.template rightCols<3>().setIdentity();
    }
  }
};

template <int B>
class Probe {
 public:
  Probe(const Network& network, const std::function<EdgeLaw(const NetworkEdge&)>& law) : network_(network) {
    law_.reserve(network.edges.size());
    double sum = 0;
    for (const NetworkEdge& e : network.edges) law_.push_back(law(e)), sum += e.branch.norm();
    if (!network.edges.empty()) length_ = sum / double(network.edges.size());
    for (int c = 0; c < 6; ++c) rate_[std::size_t(c)] = unit_rate(c);
  }

  CellResponse response(const ProbeSettings&) const;
  BlockRows<B> matrix() const;

 private:
  using Motion = Eigen::Matrix<double, B, 1>;
  template <int C>
  static Motion motion(const Stack<B, C>& x, std::uint32_t p, int c) {
    Motion m;
    for (int k = 0; k < B; ++k) m[k] = x[p][std::size_t(k * C + c)];
    return m;
  }
  EdgeMatrices<B> matrices(std::size_t e) const { return {network_.edges[e], law_[e], length_}; }
  template <int C>
  CellResponse response(const ProbeSettings&) const;
  /// Motions under the resultants `b` of forces whose squares sum up to `forces`; b is used up.
  template <int C>
  Stack<B, C> balance(Stack<B, C>& b, const std::array<double, std::size_t(C)>& forces, const ProbeSettings&,
                      CellResponse&) const;

  const Network& network_;
  std::vector<EdgeLaw> law_;
  double length_ = 1;
  std::array<Mat3, 6> rate_;
};

template <int B>
BlockRows<B> Probe<B>::matrix() const {
  const auto& edges = network_.edges;
  BlockRows<B> a;
  a.diagonal.assign(network_.particles, Tile<B, B>{});
  a.begin.assign(network_.particles + 1, 0);
  auto crosses = [](const NetworkEdge& e) { return !e.at_wall && e.i != e.j; };
  for (const auto& e : edges)
    if (crosses(e)) ++a.begin[e.i + 1], ++a.begin[e.j + 1];
  std::partial_sum(a.begin.begin(), a.begin.end(), a.begin.begin());
  struct Half {
    std::uint32_t column, edge;
  };
  std::vector<Half> half(a.begin.back());
  std::vector<std::size_t> next(a.begin.begin(), a.begin.end() - 1);
  for (std::uint32_t e = 0; e < edges.size(); ++e)
    if (crosses(edges[e])) {
      half[next[edges[e].i]++] = {edges[e].j, e};
      half[next[edges[e].j]++] = {edges[e].i, e};
    }
  a.column.resize(half.size());
  a.block.resize(half.size());
  a.branch.resize(half.size());
  using Matrix = Eigen::Map<Eigen::Matrix<double, B, B, Eigen::RowMajor>>;
  for (std::uint32_t p = 0; p < network_.particles; ++p) {
    const auto begin = half.begin() + std::ptrdiff_t(a.begin[p]), end = half.begin() + std::ptrdiff_t(a.begin[p + 1]);
    std::stable_sort(begin, end, [](const Half& x, const Half& y) { return x.column < y.column; });
    a.middle.push_back(
        std::size_t(std::find_if(begin, end, [&](const Half& h) { return h.column > p; }) - half.begin()));
    for (std::size_t h = a.begin[p]; h < a.begin[p + 1]; ++h) {
      const NetworkEdge& e = edges[half[h].edge];
      const EdgeMatrices<B> m = matrices(half[h].edge);
      const bool first = e.i == p;
      a.column[h] = half[h].column;
      a.branch[h] = (first ? e.branch : Vec3(-e.branch)) / length_;
      const auto& own = first ? m.i : m.j;
      const auto& other = first ? m.j : m.i;
      const auto& own_turn = first ? m.turn_i : m.turn_j;
      const auto& other_turn = first ? m.turn_j : m.turn_i;
      Matrix(a.block[h].data()) = own.transpose() * m.stiffness * other + own_turn.transpose() * m.turning * other_turn;
      Matrix(a.diagonal[p].data()) += own.transpose() * m.stiffness * own + own_turn.transpose() * m.turning * own_turn;
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (crosses(edges[e])) continue;
    const EdgeMatrices<B> m = matrices(e);
    const auto both = (m.i + m.j).eval(), turn = (m.turn_i + m.turn_j).eval();
    Matrix(a.diagonal[edges[e].i].data()) +=
        both.transpose() * m.stiffness * both + turn.transpose() * m.turning * turn;
  }
  // What nothing else resists would be resisted by rounding.
  constexpr double ground = 1e-13;
  for (auto& d : a.diagonal) {
    double trace = 0;
    for (int k = 0; k < B; ++k) trace += d[std::size_t(k * B + k)];
    a.scale.push_back(trace);
    for (int k = 0; k < B; ++k) d[std::size_t(k * B + k)] += ground * trace;
  }
  return a;
}

template <int B>
template <int C>
Stack<B, C> Probe<B>::balance(Stack<B, C>& b, const std::array<double, std::size_t(C)>& forces,
                              const ProbeSettings& settings, CellResponse& response) const {
  constexpr std::size_t most_neighbours = 10;  // more fill the core, fewer leave more iterations
  Elimination<B> elimination(matrix(), most_neighbours);
  const Multigrid<B> solver(elimination.take_core(), settings.direct_nodes);
  response.bytes = elimination.bytes() + solver.bytes();
  // In a lattice the resultants are rounding; they need no relaxing.
  constexpr double rounding = 1e-13;
  constexpr int most_iterations = 500;
  typename Multigrid<B>::template Goal<C> goal{settings.tolerance, {}, most_iterations, settings.watch};
  for (std::size_t c = 0; c < std::size_t(C); ++c) goal.floor[c] = rounding * std::sqrt(forces[c]);
  Stack<B, C> core, x;
  const auto report = solver.template solve<C>(elimination.template forward<C>(b), core, goal);
  elimination.template back<C>(b, core, x);
  response.iterations = report.iterations;
  response.imbalance = report.error;
  constexpr double usable = 1e-4;  // stresses go with its square
  if (!report.converged && !(report.error <= usable)) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the network's forces could not be balanced (to %.2g of the start in %d iterations); it may have parts "
        "that next to nothing holds",
        report.error, report.iterations);
    throw RunError(text);
  }
  return x;
}

template <int B>
template <int C>
CellResponse Probe<B>::response(const ProbeSettings& settings) const {
  const auto& edges = network_.edges;
  CellResponse response;
  // Column 6 is the cell at rest under the active forces.
  auto moves = [&](std::size_t e, std::size_t c) {
    return c < 6 ? Vec3(rate_[c] * edges[e].branch) : Vec3(Vec3::Zero());
  };
  auto active = [&](std::size_t e, std::size_t c) {
    return c < 6 ? Vec3(Vec3::Zero()) : Vec3(law_[e].force * edges[e].normal);
  };
  auto add_stress = [&](std::size_t c, const Vec3& f, const Vec3& branch, Mat6& matrix, Vec6& at_rest) {
    const Vec6 s = stress_of(f, branch) / settings.volume;
    if (c < 6)
      matrix.col(Eigen::Index(c)) += s;
    else
      at_rest += s;
  };
  Stack<B, C> pull(network_.particles, Tile<B, C>{});
  std::array<double, std::size_t(C)> forces{};  // squares, of all edges
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const EdgeMatrices<B> m = matrices(e);
    for (std::size_t c = 0; c < std::size_t(C); ++c) {
      const Vec3 f = m.stiffness * moves(e, c) + active(e, c);
      add_stress(c, f, edges[e].branch, response.affine, response.affine_active);
      forces[c] += f.squaredNorm();
      const Motion on_i = m.i.transpose() * f, on_j = m.j.transpose() * f;
      for (int k = 0; k < B; ++k) {
        const std::size_t at = std::size_t(k * C) + c;
        pull[edges[e].i][at] -= on_i[k];
        if (!edges[e].at_wall) pull[edges[e].j][at] -= on_j[k];
      }
    }
  }
  const Stack<B, C> x = balance<C>(pull, forces, settings, response);
  Mat6 power = Mat6::Zero();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const EdgeMatrices<B> m = matrices(e);
    const std::uint32_t i = edges[e].i, j = edges[e].at_wall ? i : edges[e].j;  // at a wall m.j is zero
    Eigen::Matrix<double, 3, C> opening, turn;
    for (int c = 0; c < C; ++c) {
      const Motion a = motion<C>(x, i, c), b = motion<C>(x, j, c);
      opening.col(c) = moves(e, std::size_t(c)) + m.i * a + m.j * b;
      turn.col(c) = m.turn_i * a + m.turn_j * b;
    }
    const Eigen::Matrix<double, 3, C> f = m.stiffness * opening;
    power += (opening.transpose() * f + turn.transpose() * m.turning * turn).template topLeftCorner<6, 6>();
    for (std::size_t c = 0; c < std::size_t(C); ++c)
      add_stress(c, f.col(Eigen::Index(c)) + active(e, c), edges[e].branch, response.relaxed, response.relaxed_active);
  }
  const double largest = response.affine.cwiseAbs().maxCoeff();
  constexpr double nothing = 1e-6;  // as good as the checks
  response.floppy = response.relaxed.cwiseAbs().maxCoeff() <= nothing * largest;
  if (response.floppy) {
    response.relaxed.setZero();
  } else {
    response.asymmetry = (response.relaxed - response.relaxed.transpose()).cwiseAbs().maxCoeff() / largest;
    response.power_mismatch = (power / settings.volume - response.relaxed).cwiseAbs().maxCoeff() / largest;
    const Mat6 symmetric = 0.5 * (response.relaxed + response.relaxed.transpose());
    response.smallest_eigenvalue = Eigen::SelfAdjointEigenSolver<Mat6>(symmetric).eigenvalues()[0] / largest;
  }
  return response;
}

template <int B>
CellResponse Probe<B>::response(const ProbeSettings& settings) const {
  const bool active = std::any_of(law_.begin(), law_.end(), [](const EdgeLaw& l) { return l.force != 0; });
  return active ? response<7>(settings) : response<6>(settings);
}

}  // namespace

CellResponse probe_cell(const Network& network, const std::function<EdgeLaw(const NetworkEdge&)>& law,
                        const ProbeSettings& settings) {
  return settings.rotation == Rotation::free ? Probe<6>(network, law).response(settings)
                                             : Probe<3>(network, law).response(settings);
}

void require_sound(const CellResponse& r, double tolerance) {
  auto refuse = [&](const char* what, double figure) {
    char text[200];
    std::snprintf(text, sizeof text, "%s (%.2g of the largest entry, %.2g is allowed): the solution is not good enough",
                  what, figure, tolerance);
    throw RunError(text);
  };
  if (!r.relaxed.allFinite()) throw RunError("the relaxed tensor is not finite: the solution is not good enough");
  if (r.asymmetry > tolerance) refuse("the relaxed tensor is not symmetric", r.asymmetry);
  if (r.power_mismatch > tolerance)
    refuse("stress times rate is not the work of the contacts (Hill-Mandel)", r.power_mismatch);
  if (r.smallest_eigenvalue < -tolerance) refuse("the relaxed tensor has a negative eigenvalue", r.smallest_eigenvalue);
}

std::size_t count_soft_modes(const Network& network, const std::function<EdgeLaw(const NetworkEdge&)>& law,
                             Rotation rotation, double share) {
  return rotation == Rotation::free ? count_soft_modes(Probe<6>(network, law).matrix(), share)
                                    : count_soft_modes(Probe<3>(network, law).matrix(), share);
}

}  // namespace densify::dem
