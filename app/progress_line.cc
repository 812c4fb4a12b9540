#include "app/progress_line.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>

namespace densify::app {

namespace {

std::atomic<bool> stop_requested{false};

extern "C" void request_stop(int) {
  stop_requested = true;
}

std::string duration(double seconds) {
  if (!(seconds >= 0)) return "-";
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min {:.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60.0));
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

const std::atomic<bool>& catch_signals() {
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is to be a failed write, as a full disk is
  return stop_requested;
}

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO)) {}

void ProgressLine::put(const std::string& line, int tenth) {
  if (quiet_) return;
  if (terminal_) {
    fmt::print(stderr, "\r{:<118s}", line);
    std::fflush(stderr);
    open_ = true;
  } else if (tenth != last_tenth_) {
    fmt::print(stderr, "{}\n", line);
  }
  last_tenth_ = tenth;
}

void ProgressLine::show(const dem::Progress& p) {
  if (p.stage == "packing")
    put(fmt::format("packing {:3.0f} %  left {}", 100 * p.share, duration(p.seconds_left)), int(10 * p.share));
  else
    put(fmt::format("{:3.0f} %  {:<16.16s} t {:>8.4g} s  T {:6.1f} K  p {:6.2f} MPa  density {}  {:>9.3g} steps/s  "
                    "left {}",
                    100 * p.share, p.stage, p.time, p.temperature, p.pressure * 1e-6,
                    std::isfinite(p.relative_density) ? fmt::format("{:.4f}", p.relative_density) : "-",
                    p.steps_per_second, duration(p.seconds_left)),
        100 + int(10 * p.share));
}

void ProgressLine::show_count(const char* what, std::size_t done, std::size_t all, double share, double seconds_left) {
  put(fmt::format("{:3.0f} %  {} of {} {} done  left {}", 100 * share, done, all, what, duration(seconds_left)),
      int(10 * share));
}

void ProgressLine::show_solution(const std::string& what, double share) {
  put(fmt::format("{:3.0f} %  balancing forces: {}", 100 * share, what), int(10 * share));
}

void ProgressLine::say(const std::string& line) {
  if (quiet_) return;
  end();
  fmt::print(stderr, "{}\n", line);
}

void ProgressLine::end() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

}  // namespace densify::app
