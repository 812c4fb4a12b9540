// densify voxel-moduli: the program with deal.II and PETSc; densify starts it.

#include "app/mpi_main.h"
#include "app/voxel_moduli.h"
#include "base/check.h"

namespace {

int run_main(int argc, char** argv) {
  densify::app::VoxelCommand command;
  CLI::App app{
      "Elastic moduli of a packing in a periodic cell, or of spheres at random, by finite elements on voxels."};
  app.name("densify voxel-moduli");
  app.footer(std::string("densify voxel-moduli --ranks N runs it on N processes.\n") + densify::app::exit_codes);
  densify::app::add_choice(app, command);
  app.get_option("RESULT")->required(false);
  app.add_option("--voxels", command.voxels, "Voxels along the longest edge, again for each; without it 32, 48, 64")
      ->check(CLI::Range(4, 512))
      ->take_all();
  app.add_flag("--pores", command.pores,
               "The body is what the packing leaves free: its solid fraction is 1 less the relative density");
  std::string temperature;
  app.add_option("--temperature", temperature,
                 "At which a packing's materials have their moduli, e.g. \"20 degC\"; without it that of the snapshot");
  app.add_option("--tolerance", command.tolerance, "Of the balance of forces; without it 1e-6")
      ->check(CLI::Range(1e-12, 1e-2));
  app.add_option("--spheres", command.spheres,
                 "Instead of a result: random overlapping spheres, \"solid\" or \"pores\"")
      ->check(CLI::IsMember({"solid", "pores"}));
  app.add_option("--solid-fraction", command.fractions, "Of the random spheres' body, again for each")
      ->check(CLI::Range(0.01, 0.999))
      ->take_all();
  app.add_option("--realisations", command.realisations, "Of each; without it 5")->check(CLI::Range(1, 10000));
  app.add_option("--box", command.box, "Edge of the random spheres' cell over their radius; without it 12")
      ->check(CLI::Range(2.0, 1000.0));
  app.add_option("--poissons-ratio", command.poissons_ratio,
                 "Of the random spheres' solid, of modulus 1; without it 0.3")
      ->check(CLI::Range(-0.9, 0.49));
  if (const int code = densify::app::parse_on_all(app, argc, argv); code >= 0) return code;
  if (!temperature.empty()) command.temperature = densify::app::parsed_temperature(temperature);
  return densify::app::voxel_command(command, MPI_COMM_WORLD);
}

}  // namespace

int main(int argc, char** argv) {
  return densify::app::mpi_main(argv, [&] { return run_main(argc, argv); });
}
