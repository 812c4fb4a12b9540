#pragma once
// What the programs' command lines share: options of commands on results, exit codes.

#include <CLI/CLI.hpp>
#include <functional>

#include "app/chosen_result.h"

namespace densify::app {

inline constexpr const char* exit_codes =
    "Exit codes: 0 done; 1 internal error; 2 bad input; 3 run stopped by a guard; 4 file error; 5 interrupted, "
    "checkpoint written.";

/// Options of the commands that read a result, RESULT among them.
void add_choice(CLI::App& command, ChosenResult&);
/// Which moments of it.
void add_moments(CLI::App& command, ChosenResult&);

/// The value of --temperature [K], above 0.  Throws InputError.
double parsed_temperature(const std::string& text);

/// What `program` returns, or the exit code of what it throws, whose text goes to the error stream.
int guarded(const std::function<int()>& program);

}  // namespace densify::app
