#include "dem/law/friction.h"

#include <gtest/gtest.h>

namespace densify::dem {
namespace {

constexpr double k_n = 1e5, ratio = 0.5, normal_force = 2.0, mu = 0.3, step = 1e-4;

TangentialInput input(const Vec3& velocity) {
  return {Vec3::UnitZ(), velocity, normal_force, k_n, 1e-3, step};
}

FrictionModel model() {
  FrictionModel m;
  m.coefficient = mu;
  m.tangential_stiffness_ratio = ratio;
  return m;
}

// Fig. 4.6: the force on i follows j with stiffness ratio x k_n = 5e4 N/m until mu F_n = 0.6 N, at 12 um, then stays.
TEST(Coulomb, SticksThenSlides) {
  Vec3 slip = Vec3::Zero();
  const Vec3 v(1e-2, 0, 0);  // 1 um a step
  for (int n = 1; n <= 30; ++n) {
    const Vec3 f = coulomb(model(), mu, input(v), slip);
    EXPECT_NEAR(f[0], std::min(0.05 * n, 0.6), 1e-14) << n;
    EXPECT_EQ(f[1], 0);
  }
  EXPECT_NEAR(slip[0], 12e-6, 1e-18);  // the spring is cut back to what sliding stretches
}

// Sliding, then back: the force falls along the stiffness, so that one closed loop of +-20 um dissipates
// 4 mu F_n (20 um - 12 um) = 19.2 uJ.  The sum f dx at the end of 1 um steps takes 4 x 0.6 N x 8 um exactly while
// sliding; the elastic parts cancel but for half a step at each of the two turns' ends.
TEST(Coulomb, ClosedLoopDissipates) {
  Vec3 slip = Vec3::Zero();
  double work = 0;
  auto move = [&](double direction, int steps, bool count) {
    for (int n = 0; n < steps; ++n) {
      const Vec3 f = coulomb(model(), mu, input(Vec3(direction * 1e-2, 0, 0)), slip);
      if (count) work += f[0] * direction * 1e-6;
    }
  };
  move(+1, 20, false);
  move(-1, 40, true);
  move(+1, 40, true);
  EXPECT_NEAR(work, 4 * 0.6 * 8e-6, 2 * 1.2 * 1e-6);
}

// Steps ten times finer bring the loop within 1 %.
TEST(Coulomb, ClosedLoopConverges) {
  Vec3 slip = Vec3::Zero();
  double work = 0;
  for (int n = 0; n < 20000 + 80000; ++n) {
    const double direction = n < 20000 ? 1 : n < 60000 ? -1 : 1;
    const Vec3 f = coulomb(model(), mu, input(Vec3(direction * 1e-5, 0, 0)), slip);
    if (n >= 20000) work += f[0] * direction * 1e-9;
  }
  EXPECT_NEAR(work / (4 * 0.6 * 8e-6), 1, 1e-3);
}

// The spring turns with the contact plane: no normal component is left after the normal has moved.
TEST(Coulomb, SpringStaysInTheContactPlane) {
  Vec3 slip(3e-6, 0, 0);
  TangentialInput in = input(Vec3::Zero());
  in.normal = Vec3(std::sin(0.1), 0, std::cos(0.1));
  const Vec3 f = coulomb(model(), mu, in, slip);
  EXPECT_NEAR(slip.dot(in.normal), 0, 1e-20);
  EXPECT_NEAR(f.dot(in.normal), 0, 1e-15);
}

// Damper c = 2 xi sqrt(m k_t) = 2 x 0.5 sqrt(1e-3 x 5e4) N s/m adds c v below the limit, and the limit covers both.
TEST(Coulomb, TangentialDamper) {
  FrictionModel m = model();
  m.tangential_damping_ratio = 0.5;
  const double c = std::sqrt(50.0);
  Vec3 slip = Vec3::Zero();
  EXPECT_NEAR(coulomb(m, mu, input(Vec3(0, 1e-2, 0)), slip)[1], 0.05 + c * 1e-2, 1e-14);
  EXPECT_NEAR(coulomb(m, mu, input(Vec3(0, 1, 0)), slip).norm(), 0.6, 1e-14);
}

// Without a normal force there is no friction and no stretched spring.
TEST(Coulomb, NothingWithoutNormalForce) {
  Vec3 slip(1e-6, 0, 0);
  TangentialInput in = input(Vec3(1e-2, 0, 0));
  in.normal_force = 0;
  EXPECT_EQ(coulomb(model(), mu, in, slip).norm(), 0);
  EXPECT_EQ(slip.norm(), 0);
}

}  // namespace
}  // namespace densify::dem
