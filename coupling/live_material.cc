#include "coupling/live_material.h"

#include <deal.II/base/mpi.h>

#include <cmath>

#include "base/check.h"
#include "fem/press/step_refused.h"

namespace densify::coupling {

namespace {

namespace mpi = dealii::Utilities::MPI;

constexpr int most_rounds = 6;  // of laws in a step
constexpr double loosely = 10;  // times the tolerance, that may be left after them: no error adds up by it
constexpr int axial_shear = 4;  // rz, the only shear of a body of revolution

/// The first of the elements that a rank has of `all`, as the finite elements are given to it.
std::size_t first_of(std::size_t all, unsigned rank, unsigned ranks) {
  return (all * rank + ranks - 1) / ranks;
}

}  // namespace

LiveMaterial::LiveMaterial(const dem::Scene& scene, const LiveSettings& settings, std::size_t elements,
                           std::size_t points_of_element, MPI_Comm comm)
    : settings_(settings), all_(elements), points_(points_of_element), comm_(comm) {
  const double pressure = scene.schedule.pressure(0);
  if (!(pressure > 0))
    throw InputError(
        "process.start_pressure: live volume elements need one above 0, to which their powder is pressed before: loose "
        "particles answer with no stress");
  const unsigned rank = mpi::this_mpi_process(comm), ranks = mpi::n_mpi_processes(comm);
  first_ = first_of(all_, rank, ranks);
  const std::size_t end = first_of(all_, rank + 1, ranks);
  const std::uint64_t seed = scene.packing ? scene.packing->seed : 0;
  std::string refused;
  try {
    std::optional<dem::GreenBody> body;
    for (std::size_t k = first_; k < end; ++k) {
      if (!body || settings.seeds == ElementSeeds::each) body = pressed_powder(scene, seed + k, pressure);
      elements_.push_back(std::make_unique<LiveRve>(scene, *body));
    }
  } catch (const std::runtime_error& error) {
    refused = error.what();
  }
  // One that has failed speaks for all.
  for (const std::string& text : mpi::all_gather(comm, refused))
    if (!text.empty()) throw InputError(text);
  const double temperature = scene.schedule.temperature(0);
  for (const auto& e : elements_) growth_start_.push_back(e->solid_growth(temperature));
  growth_ = growth_now_ = growth_start_;
  law_.resize(elements_.size());
}

double LiveMaterial::mean_density() const {
  double sum = 0;
  for (const auto& e : elements_) sum += e->density();
  return mpi::sum(sum, comm_) / double(all_);
}

void LiveMaterial::begin(double, std::span<double> states) const {
  DENSIFY_EXPECT(states.size() == 2 * points_ * elements_.size());
  for (std::size_t k = 0; k < states.size() / 2; ++k) {
    states[2 * k] = elements_[k / points_]->density();
    states[2 * k + 1] = 1;
  }
}

void LiveMaterial::update(std::span<const fem::PointStep> steps, std::span<const double> before,
                          std::span<double> after, std::span<fem::PointAnswer> answers) const {
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const std::size_t e = k / points_;
    const Law& law = law_[e];
    const Vec6& strain = steps[k].strain;
    const double growth = growth_now_[e] / growth_start_[e], grown = growth / before[2 * k + 1];
    fem::PointAnswer& a = answers[k];
    const double share = law.carried.share;
    a.stress = law.stress + law.tangent * (strain - law.strain + share * (strain - law.carried.strain));
    a.tangent = (1 + share) * law.tangent;
    a.density = before[2 * k] * grown * std::exp(-strain.head<3>().sum());
    a.stored = 0;  // is part of what is called dissipated: an element does not tell them apart
    a.thermal = a.stress.head<3>().sum() * std::log(grown) / 3;
    a.dissipated = a.stress.dot(strain) - a.thermal;
    after[2 * k] = a.density;
    after[2 * k + 1] = growth;
  }
}

Vec6 LiveMaterial::mean_strain(std::span<const fem::PointStep> steps, std::size_t own) const {
  Vec6 sum = Vec6::Zero();
  double volume = 0;
  for (const fem::PointStep& s : steps.subspan(points_ * own, points_)) {
    sum += s.volume * s.strain;
    volume += s.volume;
  }
  return sum / volume;
}

template <class Work>
void LiveMaterial::in_each(const Work& work) {
  std::string refused;
  for (std::size_t e = 0; e < elements_.size() && refused.empty(); ++e) try {
      work(e);
    } catch (const RunError& error) {
      refused = "volume element " + std::to_string(first_ + e) + ": " + error.what();
    }
  for (const std::string& text : mpi::all_gather(comm_, refused))
    if (!text.empty()) throw fem::StepRefused(text);
}

void LiveMaterial::begin_step(std::span<const fem::PointStep> guess) {
  rounds_of_step_ = 0;
  tried_largest_ = largest_stress_;
  in_each([&](std::size_t e) {
    LiveRve& element = *elements_[e];
    const fem::PointStep& step = guess[points_ * e];
    growth_now_[e] = element.solid_growth(step.temperature);
    law_[e].strain = mean_strain(guess, e);
    law_[e].carried = element.carried(element.time() + step.step);
    law_[e].stress = element.try_step(law_[e].strain, element.time() + step.step);
    law_[e].tangent = element.tangent();
  });
}

bool LiveMaterial::settle(std::span<const fem::PointStep> steps) {
  ++rounds_of_step_;
  std::vector<double> off(elements_.size());
  double largest = tried_largest_;
  in_each([&](std::size_t e) {
    LiveRve& element = *elements_[e];
    Law& law = law_[e];
    const Vec6 strain = mean_strain(steps, e);
    const Vec6 foretold = law.stress + law.tangent * (strain - law.strain);
    law.stress = element.try_step(strain, element.time() + steps[points_ * e].step);
    law.strain = strain;
    off[e] = (law.stress - foretold).cwiseAbs().maxCoeff();
    largest = std::max(largest, law.stress.cwiseAbs().maxCoeff());
  });
  tried_largest_ = mpi::max(largest, comm_);
  tried_mismatch_ =
      tried_largest_ > 0
          ? mpi::max(off.empty() ? 0.0 : *std::max_element(off.begin(), off.end()), comm_) / tried_largest_
          : 0.0;
  if (tried_mismatch_ <= settings_.tolerance) return true;
  if (rounds_of_step_ == most_rounds) {
    if (tried_mismatch_ <= loosely * settings_.tolerance) return true;
    throw fem::StepRefused("stresses of volume elements and of their laws do not come together");
  }
  in_each([&](std::size_t e) {
    if (off[e] > settings_.tolerance * tried_largest_) law_[e].tangent = elements_[e]->tangent();
  });
  return false;
}

double LiveMaterial::resolution() const {
  double softest = 0;  // [1/Pa]
  for (const Law& law : law_) softest = std::max(softest, 9 / law.tangent.topLeftCorner<3, 3>().sum());
  return settings_.tolerance * tried_largest_ * mpi::max(softest, comm_);
}

void LiveMaterial::accept() {
  own_.rounds += std::uint64_t(rounds_of_step_);
  largest_stress_ = tried_largest_;
  growth_ = growth_now_;
  own_.largest_mismatch = std::max(own_.largest_mismatch, tried_mismatch_);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    elements_[e]->accept();
    own_.mismatch_work += elements_[e]->mismatch_work();
    own_.contact_work += elements_[e]->contact_work();
    Vec6 stress = law_[e].stress;
    stress[axial_shear] = 0;
    if (largest_stress_ > 0)
      own_.dropped_stress = std::max(own_.dropped_stress, stress.tail<3>().cwiseAbs().maxCoeff() / largest_stress_);
  }
}

LiveCount LiveMaterial::count() const {
  LiveCount c;
  for (const auto& e : elements_) {
    c.steps += e->steps();
    c.solutions += e->solutions();
    c.bytes += e->bytes();
  }
  c.elements = all_;
  c.steps = before_.steps + mpi::sum(c.steps, comm_);
  c.solutions = before_.solutions + mpi::sum(c.solutions, comm_);
  c.bytes = mpi::sum(c.bytes, comm_);
  c.rounds = before_.rounds + own_.rounds;
  c.largest_mismatch = std::max(before_.largest_mismatch, own_.largest_mismatch);
  c.mismatch_work = before_.mismatch_work + mpi::sum(own_.mismatch_work, comm_);
  c.contact_work = before_.contact_work + mpi::sum(own_.contact_work, comm_);
  c.dropped_stress = std::max(before_.dropped_stress, mpi::max(own_.dropped_stress, comm_));
  return c;
}

LiveMemory LiveMaterial::memory() const {
  LiveMemory m{{}, largest_stress_, count()};
  std::vector<std::string> own;
  for (const auto& e : elements_) own.push_back(e->image());
  for (auto& part : mpi::gather(comm_, own, 0)) std::move(part.begin(), part.end(), std::back_inserter(m.images));
  return m;
}

void LiveMaterial::restore(const LiveMemory& m) {
  if (m.images.size() != all_) throw FileError("the checkpoint holds another number of volume elements");
  for (std::size_t e = 0; e < elements_.size(); ++e) elements_[e]->restore(m.images[first_ + e]);
  largest_stress_ = m.largest_stress;
  before_ = m.count;
}

}  // namespace densify::coupling
