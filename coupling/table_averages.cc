// From the points of several elements to the nodes of their table.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "coupling/table_curves.h"
#include "coupling/tabulate.h"

namespace densify::coupling {

namespace {

constexpr int cold_nodes = 25, sintering_nodes = 40;
constexpr double towards_start = 1.5;  // nodes are denser where responses change fastest
constexpr double apart = 1e-4;         // of ln(density), between two points that count
constexpr std::size_t fewest = 4;      // points of a curve

double node_place(int k, int n) {
  return std::pow(double(k) / (n - 1), towards_start);
}

/// Mean, and standard deviation of one row over its mean or of a logarithm.
struct Mean {
  Eigen::VectorXd value, deviation;
};

Mean mean_of(const std::vector<Eigen::VectorXd>& all) {
  Mean m{Eigen::VectorXd::Zero(all[0].size()), Eigen::VectorXd::Zero(all[0].size())};
  for (const auto& v : all) m.value += v / double(all.size());
  if (all.size() < 2) return m;
  for (const auto& v : all) m.deviation += (v - m.value).cwiseAbs2() / double(all.size() - 1);
  m.deviation = m.deviation.cwiseSqrt();
  return m;
}

/// The first points are stiffer than those after them while contacts turn into necks (4.47); they take their viscosity
/// over some relaxation times, which a table without time leaves out.
void drop_transition(std::vector<SinteringNode>& nodes) {
  std::size_t first = 0;
  for (std::size_t k = 1; k < nodes.size(); ++k)
    if (nodes[k].viscosity[1] < nodes[first].viscosity[1]) first = k;
  nodes.erase(nodes.begin(), nodes.begin() + std::ptrdiff_t(first));
}

/// Logarithm of the pressure of a node, and what is averaged at it.
Eigen::VectorXd at_pressure(const ColdNode& n) {
  Eigen::VectorXd v = curve_values(n);
  v[0] = std::log(n.density);  // in place of its pressure
  return v;
}

}  // namespace

std::vector<ColdNode> average_cold(const std::vector<PathRecord>& records) {
  // Means of densities at a pressure: those of pressures at a density would scatter by tens of per cent.
  std::vector<ShapePreserving> curves;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  for (const PathRecord& r : records) {
    std::vector<double> pressure;
    std::vector<Eigen::VectorXd> values;
    for (const PathPoint& p : r.points) {
      const double axial = -p.stress[2], lateral = -0.5 * (p.stress[0] + p.stress[1]);
      if (p.flows || !(axial > 0) || !(lateral > 0)) continue;
      const double x = std::log(axial), density = std::log(p.unloaded);
      if (!pressure.empty() && (x - pressure.back() < apart || density - values.back()[0] < apart)) continue;
      pressure.push_back(x);
      values.push_back(at_pressure({p.unloaded, axial, std::min(lateral, axial), 0, axial_part(p.stiffness)}));
    }
    if (pressure.size() < fewest)
      throw RunError("the loose powder has only " + std::to_string(pressure.size()) +
                     " states of growing density before sintering; load it further, or pack it looser");
    low = std::max(low, pressure.front()), high = std::min(high, pressure.back());
    Eigen::MatrixXd matrix(values[0].size(), Eigen::Index(values.size()));
    for (std::size_t k = 0; k < values.size(); ++k) matrix.col(Eigen::Index(k)) = values[k];
    curves.emplace_back(std::move(pressure), std::move(matrix));
  }
  if (!(high > low + apart)) throw RunError("the elements have no common pressure before sintering; take larger ones");
  std::vector<ColdNode> nodes;
  for (int k = 0; k < cold_nodes; ++k) {
    const double x = low + (high - low) * k / (cold_nodes - 1);
    std::vector<Eigen::VectorXd> all;
    for (const auto& c : curves) all.push_back(c(x));
    Mean m = mean_of(all);
    const double density = std::exp(m.value[0]);
    m.value[0] = x;
    nodes.push_back(cold_node(m.value));
    nodes.back().density = density;
    nodes.back().density_scatter = m.deviation[0] * density;
  }
  return nodes;
}

SinteringBranch average_sintering(const std::vector<PathRecord>& records, const std::string& path,
                                  double pressure_factor) {
  struct Run {
    double birth;
    std::vector<SinteringNode> nodes;
  };
  std::vector<Run> runs;
  double end = std::numeric_limits<double>::infinity(), birth = 0;
  for (const PathRecord& r : records) {
    Run run{};
    for (const PathPoint& p : r.points) {
      if (!p.flows) continue;
      if (!run.nodes.empty() && std::log(p.unloaded / run.nodes.back().density) < apart) continue;
      if (run.nodes.empty()) run.birth = p.unloaded;
      run.nodes.push_back({p.unloaded,
                           axial_part(p.viscosity),
                           axial_part(p.stiffness),
                           {0.5 * (p.sintering_stress[0] + p.sintering_stress[1]), p.sintering_stress[2]},
                           0,
                           0,
                           p.neck_state,
                           p.at_equilibrium});
    }
    drop_transition(run.nodes);
    if (run.nodes.size() < fewest)
      throw RunError("the path has only " + std::to_string(run.nodes.size()) +
                     " states with necks; prolong it, or begin with a denser packing");
    end = std::min(end, run.nodes.back().density);
    birth += run.birth / double(records.size());
    runs.push_back(std::move(run));
  }
  if (!(end > birth * (1 + apart))) throw RunError("the elements hardly densify on the path; prolong it");
  // Each element's curve from its own birth to the common end.
  std::vector<ShapePreserving> curves;
  for (const Run& run : runs) curves.push_back(sintering_curve(run.nodes, run.birth));
  SinteringBranch branch{path, birth, pressure_factor, {}};
  for (int k = 0; k < sintering_nodes; ++k) {
    const double share = node_place(k, sintering_nodes);
    std::vector<Eigen::VectorXd> all;
    for (std::size_t r = 0; r < runs.size(); ++r)
      all.push_back(
          curves[r](share * std::log(end / runs[r].birth) / std::log(runs[r].nodes.back().density / runs[r].birth)));
    const Mean m = mean_of(all);
    SinteringNode n = sintering_node(m.value);
    n.density = birth * std::exp(share * std::log(end / birth));
    n.viscosity_scatter = m.deviation[strength_rows];
    n.sintering_stress_scatter = m.deviation[11] / std::abs(m.value[11]);
    branch.nodes.push_back(n);
  }
  return branch;
}

}  // namespace densify::coupling
