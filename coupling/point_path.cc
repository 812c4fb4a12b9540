#include "coupling/point_path.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "fem/press/step_refused.h"

namespace densify::coupling {

namespace {

constexpr int steps_of_stage = 400;
constexpr int most_iterations = 60, whole_steps = 8;
constexpr double balanced = 1e-10;  // change of strain

}  // namespace

std::vector<double> drive_point(const fem::PointMaterial& material, const Schedule& schedule, PathKind kind,
                                double density, const std::vector<double>& times) {
  std::vector<double> state(material.state_size()), after(state.size()), at{density}, clock{0};
  material.begin(density, state);
  double stage_start = 0;
  for (const Stage& stage : schedule.stages()) {
    for (int k = 1; k <= steps_of_stage; ++k) {
      const double h = stage.duration / steps_of_stage, t = stage_start + k * h;
      Vec6 strain = Vec6::Zero();
      const double pressure = schedule.pressure(std::min(t, schedule.end()));
      bool found = false;
      for (int n = 0; n < most_iterations && !found; ++n) {
        const fem::PointStep step{strain, h, schedule.temperature(t - h), schedule.temperature(t)};
        fem::PointAnswer answer{};
        try {
          material.update({&step, 1}, state, after, {&answer, 1});
        } catch (const fem::StepRefused&) {
          break;
        }
        Mat3 tangent = answer.tangent.topLeftCorner<3, 3>();
        Vec3 lack = Vec3::Constant(-pressure) - answer.stress.head<3>();
        if (kind == PathKind::die) lack = {0, 0, lack[2]}, tangent.topRows<2>() << 1, 0, 0, 0, 1, 0;
        const Vec3 change = tangent.partialPivLu().solve(lack);
        found = change.norm() < balanced;
        strain.head<3>() += (n < whole_steps ? 1.0 : 0.5) * change;  // from one side of a yield to the other and back
      }
      if (!found) throw RunError("a point of the material does not follow the path at " + std::to_string(t) + " s");
      state = after;
      at.push_back(material.density(state));
      clock.push_back(t);
    }
    stage_start += stage.duration;
  }
  std::vector<double> result;
  for (const double t : times) {
    const auto k = std::min<std::size_t>(std::size_t(std::upper_bound(clock.begin(), clock.end(), t) - clock.begin()),
                                         clock.size() - 1);
    result.push_back(std::lerp(at[k - 1], at[k], (t - clock[k - 1]) / (clock[k] - clock[k - 1])));
  }
  return result;
}

}  // namespace densify::coupling
