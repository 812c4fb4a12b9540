// The command line: one function a command, nothing else.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "app/bench.h"
#include "app/check.h"
#include "app/command_line.h"
#include "app/compare_moduli.h"
#include "app/fem_program.h"
#include "app/moduli.h"
#include "app/run.h"
#include "app/stresses.h"
#include "app/trade.h"
#include "app/trade_ladder.h"
#include "base/check.h"
#include "base/nearest.h"
#include "base/version.h"
#include "dem/io/scene.h"

namespace {

int run_main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "voxel-moduli")
    densify::app::become_program(densify::app::voxel_program, "voxel-moduli", {argv + 2, argv + argc});
  if (argc > 1 && std::string_view(argv[1]) == "tabulate")
    densify::app::become_program(densify::app::tabulate_program, "tabulate", {argv + 2, argv + argc});
  CLI::App app{"Densify: how a powder becomes a solid part under heat and pressure."};
  app.name("densify");
  app.footer(densify::app::exit_codes);
  app.set_version_flag(
      "--version", "densify " + std::string(densify::version()) + " (" + std::string(densify::git_revision()) + ")");
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("densify: ") + error.what() + "; densify --help says what there is\n";
  });

  densify::app::RunCommand run;
  CLI::App* run_command = app.add_subcommand("run", "Run a scene to its end");
  run_command->add_option("SCENE", run.scene, "A scene file, or a folder that holds scene.toml")->required();
  run_command->add_option("--out", run.folder, "Folder of the results; without it results/NAME");
  run_command->add_option("--set", run.overrides, "path.to.key=value, again for each")->take_all();
  run_command
      ->add_option("--threads", run.threads,
                   "Threads; results do not depend on their number; without it one, or with realisations one a core")
      ->check(CLI::Range(1, 1024));
  run_command->add_option("--ranks", run.ranks, "Processes (MPI) of a scene that presses a whole specimen")
      ->check(CLI::Range(1, 4096));
  run_command->add_flag("--resume", run.resume, "Continue from the checkpoint in the folder of the results");
  run_command->add_flag("--quiet", run.quiet, "No progress, no summary");

  densify::app::CheckCommand check;
  CLI::App* check_command =
      app.add_subcommand("check", "Check a scene: memory, critical step, number of steps, expected time; runs nothing");
  check_command->add_option("SCENE", check.scene, "A scene file, or a folder that holds scene.toml")->required();
  check_command->add_option("--set", check.overrides, "path.to.key=value, again for each")->take_all();
  check_command->add_option("--threads", check.threads, "Threads")->check(CLI::Range(1, 1024));

  densify::app::BenchOptions bench;
  CLI::App* bench_command = app.add_subcommand("bench", "Time the contact pass on the shipped packings and check it");
  bench_command->add_option("--packing", bench.packings, "m2k, m20k or p1751; without it all three")->take_all();
  bench_command->add_option("--case", bench.cases, "A (no friction), B (friction) or S (sintering); without it A and B")
      ->take_all();
  bench_command->add_option("--threads", bench.threads, "Threads")->check(CLI::Range(1, 1024));
  bench_command->add_option("--steps", bench.steps, "Steps of one repeat; without it as many as take half a second");
  bench_command->add_flag("--features", bench.features, "A table of what each feature of a scene costs");
  bench_command->add_flag("--lists", bench.lists,
                          "Pairs of the lists for one contact, with size ratios of 1.1, 12 and 50");
  bench_command->add_flag("--scaling", bench.scaling, "Case A on 2e3 to 1e6 particles");
  bench_command->add_flag("--json", bench.json, "JSON instead of a table");

  densify::app::TradeCommand trade;
  CLI::App* trade_command = app.add_subcommand(
      "trade", "Measure what each setting of a scene costs and how far it is from the converged one");
  trade_command->add_option("SCENE", trade.scene, "A scene file, or a folder that holds scene.toml")->required();
  trade_command->add_option("--out", trade.folder, "Folder of runs, table and plot")->required();
  trade_command->add_option("--ladder", trade.ladder, "A file of settings to compare; without it the built-in ladder");
  trade_command->add_option("--set", trade.overrides, "path.to.key=value of all rungs, again for each")->take_all();
  trade_command->add_option("--realisations", trade.realisations, "Of every rung; without it as the ladder says")
      ->check(CLI::Range(2, 100000));
  trade_command->add_option("--threads", trade.threads, "Runs at a time, one thread each; without it one a core")
      ->check(CLI::Range(1, 1024));
  trade_command->add_flag("--resume", trade.resume, "Keep the finished runs in the folder and make the others");
  trade_command->add_flag("--quiet", trade.quiet, "No progress, no tables");

  densify::app::ModuliCommand moduli;
  CLI::App* moduli_command = app.add_subcommand(
      "moduli", "Elastic moduli, viscosities and sintering stress of the contact network at moments of a result");
  densify::app::add_choice(*moduli_command, moduli);
  moduli_command
      ->add_option("--model", moduli.models,
                   "Contact model: normal_spring, bonded_neck, neck_beam or series; again for each; without it all")
      ->take_all();
  moduli_command
      ->add_option("--tangential", moduli.tangential,
                   "Lateral over normal stiffness of a contact; without it the model's")
      ->check(CLI::Range(0.0, 10.0));
  moduli_command
      ->add_option("--tangential-viscosity", moduli.tangential_viscosity, "Lateral over normal viscosity of a contact")
      ->check(CLI::Range(0.0, 10.0));
  moduli_command
      ->add_option("--rigid", moduli.rigid,
                   "Viscosity of contacts that do not flow, over the median of those that do; without it 1e4")
      ->check(CLI::Range(1.0, 1e12));
  moduli_command->add_flag("--soft-modes", moduli.soft_modes,
                           "Count the motions that nothing resists; factorises, for up to some thousand particles");

  densify::app::StressesCommand stresses;
  CLI::App* stresses_command = app.add_subcommand(
      "stresses", "Stress in necks, particles and the specimen at moments of a result: tables and histograms");
  densify::app::add_choice(*stresses_command, stresses);

  app.add_subcommand("tabulate", "Response table of a volume element, for a pressing; its own --help");
  app.add_subcommand("voxel-moduli", "Elastic moduli by finite elements on voxels (deal.II, PETSc); its own --help");

  densify::app::CompareCommand compare;
  CLI::App* compare_command = app.add_subcommand(
      "compare-moduli",
      "Moduli along the densification by contact networks and voxel elements, beside curves, bounds and measurements");
  densify::app::add_comparison_options(*compare_command, compare);

  CLI::App* ladder_command =
      app.add_subcommand("help-ladder", "Every key of a ladder with unit, range, default and meaning");
  CLI::App* scene_command =
      app.add_subcommand("help-scene", "Every key of a scene with unit, range, default and meaning");
  bool press_keys = false;
  scene_command->add_flag("--press", press_keys, "Of a scene that presses a whole specimen");
  CLI::App* help_command = app.add_subcommand("help", "This text");

  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (argc > 1 && argv[1][0] != '-' && std::find(commands.begin(), commands.end(), argv[1]) == commands.end())
    throw densify::InputError("\"" + std::string(argv[1]) + "\" is not a command; densify --help lists them" +
                              densify::did_you_mean(argv[1], commands));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  if (run_command->parsed() && densify::app::is_press_scene(run.scene))
    densify::app::become_program(densify::app::press_program, "a scene with [press]", {argv + 2, argv + argc});
  if (run_command->parsed()) return densify::app::run_command(run);
  if (check_command->parsed() && densify::app::is_press_scene(check.scene)) {
    std::vector<std::string> words{argv + 2, argv + argc};
    words.push_back("--check");
    densify::app::become_program(densify::app::press_program, "a scene with [press]", words);
  }
  if (check_command->parsed()) return densify::app::check_command(check);
  if (bench_command->parsed()) return densify::app::bench_command(bench);
  if (moduli_command->parsed()) return densify::app::moduli_command(moduli);
  if (compare_command->parsed()) return densify::app::compare_command(compare);
  if (stresses_command->parsed()) return densify::app::stresses_command(stresses);
  if (trade_command->parsed()) return densify::app::trade_command(trade);
  if (ladder_command->parsed()) std::fputs(densify::app::ladder_help().c_str(), stdout);
  if (scene_command->parsed() && press_keys)
    densify::app::become_program(densify::app::press_program, "help-scene --press", {"--help-scene"});
  if (scene_command->parsed()) std::fputs(densify::dem::scene_help().c_str(), stdout);
  if (help_command->parsed()) std::fputs(app.help().c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return densify::app::guarded([&] { return run_main(argc, argv); });
}
