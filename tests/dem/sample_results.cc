// Writes the results of a short run of two small packings into DIR/periodic (complete) and DIR/cylinder (going on), for
// the test of the Python reader: sample_results DIR.

#include <array>

#include "dem/io/result_file.h"
#include "dem/io/visualisation.h"
#include "tests/dem/small_packings.h"

using namespace densify::dem;

namespace {

void write_results(const std::filesystem::path& folder, Setup setup, bool complete) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::vector<HistoryColumn> columns{
      {"time_s", "s"}, {"stage", ""}, {"temperature_K", "K"}, {"relative_density", "1"}};
  Simulation simulation(std::move(setup));
  auto history = HistoryFile::create(folder / "history.csv", columns);
  ResultFile results(folder, {"title = \"20 °C\"\n", "0.1.0", "abc123", columns}, 0);
  // Complete results with stress fields, the others without.
  Visualisation pictures(folder / "paraview", 0, complete ? StressFields::written : StressFields::left_out);
  for (int output = 0; output < 3; ++output) {
    const State before = simulation.state();
    Recording recording;
    simulation.evaluate(&recording);
    const Moment moment{before.time, simulation.temperature(), simulation.pressure(), 0.7 + 0.1 * output, "press"};
    const Snapshot shot = take_snapshot(simulation, recording, moment);
    simulation.restore(before);
    history.add_row(std::array{moment.time, moment.temperature, moment.relative_density}, moment.stage);
    results.add_snapshot(shot);
    pictures.add(shot);
    densify::dem::testing::run_steps(simulation, 80);
  }
  if (complete) results.consolidate(ResultFile::usual_largest);
}

}  // namespace

int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  write_results(folder / "periodic", densify::dem::testing::periodic_packing(1), true);
  write_results(folder / "cylinder", densify::dem::testing::cylinder_packing(1), false);
}
