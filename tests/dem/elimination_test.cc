// Elimination of nodes with few neighbours against a dense solution of the whole.

#include "dem/network/elimination.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace densify::dem {
namespace {

constexpr int nodes = 20, columns = 6;
using Vec = Eigen::Matrix<double, 3, columns, Eigen::RowMajor>;

/// Springs between random pairs, some of them 1e6 times as stiff, and a soft one from every node to the ground.
BlockRows<3> random_network() {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<std::vector<Mat3>> block(nodes, std::vector<Mat3>(nodes, Mat3::Zero()));
  for (int i = 0; i < nodes; ++i) block[std::size_t(i)][std::size_t(i)] = 1e-3 * Mat3::Identity();
  for (int e = 0; e < 3 * nodes; ++e) {
    const auto i = std::size_t(random() % nodes), j = std::size_t(random() % nodes);
    const double x = u(random), y = u(random), z = u(random);
    const Vec3 n = Vec3(x, y, z).normalized();
    if (i == j) continue;
    const Mat3 k = (e % 5 == 0 ? 1e6 : 1) * n * n.transpose();
    block[i][i] += k, block[j][j] += k, block[i][j] -= k, block[j][i] -= k;
  }
  BlockRows<3> a;
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t j = 0; j < nodes; ++j) {
      if (i == j) a.middle.push_back(a.column.size());
      if (i == j || block[i][j].norm() == 0) continue;
      a.column.push_back(std::uint32_t(j)), a.branch.push_back(Vec3::Zero());
      Eigen::Map<Mat3>(a.block.emplace_back().data()) = block[i][j];
    }
    a.begin.push_back(a.column.size());
    Eigen::Map<Mat3>(a.diagonal.emplace_back().data()) = block[i][i];
    a.scale.push_back(block[i][i].trace());
  }
  return a;
}

Eigen::MatrixXd dense_solution(const BlockRows<3>& a, const Stack<3, columns>& b) {
  Eigen::MatrixXd right(Eigen::Index(3 * b.size()), columns);
  for (std::size_t p = 0; p < b.size(); ++p)
    right.middleRows<3>(Eigen::Index(3 * p)) = Eigen::Map<const Vec>(b[p].data());
  return Eigen::MatrixXd(assemble(a)).ldlt().solve(right);
}

// Whatever is eliminated (nothing, some, all), the solution is that of A x = b.  Condition 1e9: ten digits of sixteen
// are safe for neither, so 1e-6.
TEST(Elimination, SolutionOfTheWhole) {
  const BlockRows<3> a = random_network();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  Stack<3, columns> b(nodes);
  for (auto& tile : b)
    for (double& v : tile) v = u(random);
  const Eigen::MatrixXd exact = dense_solution(a, b);
  std::size_t before = 0;
  for (const std::size_t most : {std::size_t(0), std::size_t(5), std::size_t(nodes)}) {
    Elimination<3> elimination(a, most);
    EXPECT_GE(elimination.eliminated(), before);
    before = elimination.eliminated();
    Stack<3, columns> own = b, x;
    const Stack<3, columns> right = elimination.forward<columns>(own);
    const BlockRows<3> rest = elimination.take_core();
    ASSERT_EQ(rest.nodes() + before, std::size_t(nodes));
    for (std::size_t p = 0; p < rest.nodes(); ++p) EXPECT_GT(rest.begin[p + 1] - rest.begin[p], most);
    Stack<3, columns> core(rest.nodes());
    if (rest.nodes() > 0) {
      const Eigen::MatrixXd part = dense_solution(rest, right);
      for (std::size_t p = 0; p < rest.nodes(); ++p)
        Eigen::Map<Vec>(core[p].data()) = part.middleRows<3>(Eigen::Index(3 * p));
    }
    elimination.back<columns>(own, core, x);
    double difference = 0;
    for (std::size_t p = 0; p < nodes; ++p)
      difference += (Eigen::Map<const Vec>(x[p].data()) - exact.middleRows<3>(Eigen::Index(3 * p))).squaredNorm();
    EXPECT_LT(std::sqrt(difference) / exact.norm(), 1e-6) << most;
  }
  EXPECT_EQ(before, std::size_t(nodes));
}

}  // namespace
}  // namespace densify::dem
