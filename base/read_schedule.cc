#include <cmath>
#include <limits>

#include "base/quantity.h"
#include "base/schedule.h"
#include "base/section.h"

namespace densify {
namespace {

constexpr double kNotSet = std::numeric_limits<double>::quiet_NaN();

struct StageKeys {
  std::string name;
  double duration = kNotSet;     // [s]
  double end = kNotSet;          // [s]
  double rate = kNotSet;         // [K/s]
  double temperature = kNotSet;  // [K]
  double pressure = kNotSet;     // [Pa]
};

StageKeys read_keys(Section& section) {
  StageKeys keys;
  section.text("name", keys.name, Need::required, "name of the stage, as results call it");
  section.quantity("duration", keys.duration, dim::time, Range::positive(), Need::optional,
                   "length of the stage; give one of duration, end and rate");
  section.quantity("end", keys.end, dim::time, Range::positive(), Need::optional,
                   "end of the stage, counted from the start of the process");
  section.quantity("rate", keys.rate, dim::temperature_rate, Range::positive(), Need::optional,
                   "heating or cooling rate, always positive; the stage ends at its temperature");
  section.quantity("temperature", keys.temperature, dim::temperature, Range::non_negative(), Need::optional,
                   "temperature at the end of the stage; unchanged if absent");
  section.quantity("pressure", keys.pressure, dim::pressure, Range::non_negative(), Need::optional,
                   "pressure at the end of the stage; unchanged if absent");
  return keys;
}

// Turns whichever of duration, end and rate is given into a duration [s].
double duration_of(const Section& section, const StageKeys& keys, double start, double temperature_change) {
  std::string given;
  for (const char* key : {"duration", "end", "rate"}) {
    if (section.has(key)) given.append(given.empty() ? "" : " and ").append(key);
  }
  const std::string stage = "stage \"" + keys.name + "\"";
  if (given != "duration" && given != "end" && given != "rate") {
    const std::string problem = stage + " needs exactly one of duration, end and rate, found ";
    if (given.empty()) section.fail_missing({"duration", "end", "rate"}, problem + "none");
    section.fail("", problem + given);
  }
  if (given == "end" && keys.end <= start) {
    section.fail("end", stage + " goes back in time (it starts at " + format_quantity(start, dim::time) +
                            "); end counts from the start of the process, so give a later one or a duration");
  }
  if (given == "rate" && temperature_change == 0.0) {
    section.fail("rate", stage + " has a rate but does not change the temperature; give a temperature or a duration");
  }
  if (given == "end") return keys.end - start;
  return given == "rate" ? std::abs(temperature_change) / keys.rate : keys.duration;
}

}  // namespace

Schedule read_schedule(Section& process, const std::function<void(Section&, double, double)>& also) {
  double start_temperature = 293.15;
  double start_pressure = 0.0;
  process.quantity("start_temperature", start_temperature, dim::temperature, Range::non_negative(), Need::optional,
                   "temperature at the start of the process");
  process.quantity("start_pressure", start_pressure, dim::pressure, Range::non_negative(), Need::optional,
                   "pressure at the start of the process");
  std::vector<Stage> stages;
  double time = 0.0;
  double temperature = start_temperature;
  double pressure = start_pressure;
  process.list("stage", Need::required, "stages of the process in order", [&](Section& section, std::size_t) {
    const StageKeys keys = read_keys(section);
    if (also) also(section, pressure, keys.pressure);
    if (section.documenting()) return;
    const double end_temperature = std::isnan(keys.temperature) ? temperature : keys.temperature;
    const double duration = duration_of(section, keys, time, end_temperature - temperature);
    temperature = end_temperature;
    if (!std::isnan(keys.pressure)) pressure = keys.pressure;
    time += duration;
    stages.push_back({keys.name, duration, temperature, pressure});
  });
  if (process.documenting()) stages.push_back({"help", 1.0, start_temperature, start_pressure});
  return Schedule(start_temperature, start_pressure, std::move(stages));
}

}  // namespace densify
