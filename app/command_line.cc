#include "app/command_line.h"

#include <cstdio>

#include "base/check.h"
#include "base/quantity.h"

namespace densify::app {

void add_choice(CLI::App& command, ChosenResult& result) {
  command.add_option("RESULT", result.source, "A folder of results, a result.h5, or a scene, which is run first")
      ->required();
  command.add_option("--out", result.folder, "Folder of the tables; without it that of the result");
  add_moments(command, result);
}

void add_moments(CLI::App& command, ChosenResult& result) {
  command.add_option("--at-time", result.times, "The snapshot nearest to a time, e.g. \"20 min\"; again for each")
      ->take_all();
  command.add_option("--at-density", result.densities, "The snapshot nearest to a relative density; again for each")
      ->take_all();
  command.add_option("--set", result.overrides, "path.to.key=value of a scene, again for each")->take_all();
  command.add_option("--threads", result.threads, "Threads of a scene's run")->check(CLI::Range(1, 1024));
  command.add_flag("--quiet", result.quiet, "Tables only");
}

double parsed_temperature(const std::string& text) {
  double temperature;
  try {
    temperature = parse_quantity(text, dim::temperature);
  } catch (const QuantityError& error) {
    throw InputError("--temperature " + text + ": " + error.what());
  }
  if (!(temperature > 0)) throw InputError("--temperature " + text + ": not above absolute zero");
  return temperature;
}

int guarded(const std::function<int()>& program) {
  auto fail = [](const std::exception& error, int code) {
    std::fprintf(stderr, "densify: %s\n", error.what());
    return code;
  };
  try {
    return program();
  } catch (const InputError& error) {
    return fail(error, 2);
  } catch (const RunError& error) {
    return fail(error, 3);
  } catch (const FileError& error) {
    return fail(error, 4);
  } catch (const Interrupted& error) {
    return fail(error, 5);
  } catch (const std::exception& error) {
    return fail(error, 1);
  }
}

}  // namespace densify::app
