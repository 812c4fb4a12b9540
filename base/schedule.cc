#include "base/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"

namespace densify {
namespace {

void require(bool condition, const std::string& place, const char* message) {
  if (!condition) throw InputError(place + ": " + message);
}

}  // namespace

Schedule::Schedule(double start_temperature, double start_pressure, std::vector<Stage> stages)
    : stages_(std::move(stages)), points_{{0.0, start_temperature, start_pressure}} {
  require(!stages_.empty(), "process", "there is no stage; give at least one");
  for (const Stage& stage : stages_) {
    const double time = points_.back().time + stage.duration;
    require(stage.duration > 0.0 && time > points_.back().time && std::isfinite(time), "stage " + stage.name,
            "the duration must be positive, and finite");
    points_.push_back({time, stage.end_temperature, stage.end_pressure});
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::string place = i == 0 ? "process start" : "stage " + stages_[i - 1].name;
    require(points_[i].temperature >= 0.0 && std::isfinite(points_[i].temperature), place,
            "the temperature must be at least 0 K, and finite");
    require(points_[i].pressure >= 0.0 && std::isfinite(points_[i].pressure), place,
            "the pressure must not be negative, and finite");
  }
}

std::size_t Schedule::stage_at(double t) const {
  const auto later = std::upper_bound(points_.begin() + 1, points_.end() - 1, t,
                                      [](double time, const Point& point) { return time < point.time; });
  return static_cast<std::size_t>(later - points_.begin()) - 1;
}

double Schedule::value(double t, double Point::*member) const {
  if (t <= 0.0) return points_.front().*member;
  if (t >= end()) return points_.back().*member;
  const std::size_t k = stage_at(t);
  const Point& a = points_[k];
  const Point& b = points_[k + 1];
  return a.*member + (b.*member - a.*member) * ((t - a.time) / (b.time - a.time));
}

double Schedule::rate(double t, double Point::*member) const {
  if (t < 0.0 || t >= end()) return 0.0;
  const std::size_t k = stage_at(t);
  const Point& a = points_[k];
  const Point& b = points_[k + 1];
  return (b.*member - a.*member) / (b.time - a.time);
}

double Schedule::temperature(double t) const {
  return value(t, &Point::temperature);
}
double Schedule::temperature_rate(double t) const {
  return rate(t, &Point::temperature);
}
double Schedule::pressure(double t) const {
  return value(t, &Point::pressure);
}
double Schedule::pressure_rate(double t) const {
  return rate(t, &Point::pressure);
}

double Schedule::next_breakpoint(double t) const {
  if (t >= end()) return std::numeric_limits<double>::infinity();
  return stage_end(stage_at(t));
}

double Schedule::peak_temperature() const {
  return std::max_element(points_.begin(), points_.end(),
                          [](const Point& a, const Point& b) { return a.temperature < b.temperature; })
      ->temperature;
}

double Schedule::peak_pressure() const {
  return std::max_element(points_.begin(), points_.end(),
                          [](const Point& a, const Point& b) { return a.pressure < b.pressure; })
      ->pressure;
}

}  // namespace densify
