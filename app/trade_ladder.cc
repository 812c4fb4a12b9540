#include "app/trade_ladder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/scene_document.h"
#include "dem/law/contact_model.h"
#include "dem/material/pair_table.h"
#include "dem/specimen.h"

namespace densify::app {

namespace {

Ladder visit(Section root) {
  Ladder ladder;
  root.integer("realisations", ladder.realisations, 2, 100000, Need::optional,
               "of every rung: the same packings, or the same perturbations when the scene has them");
  root.text_list("set", ladder.set, Need::optional, "overrides of all rungs, before their own");
  root.quantity_list("times", ladder.times, dim::time, Range::non_negative(), Need::optional,
                     "process times besides the ends of stages at which densities are compared");
  std::size_t converged = 0;
  root.list("rung", Need::required, "one setting", [&](Section& section, std::size_t) {
    Rung& rung = ladder.rungs.emplace_back();
    section.text("name", rung.name, Need::required, "in table and plot");
    section.text_list("set", rung.set, Need::optional,
                      "overrides of the scene, path.to.key=value; path.to.key= removes the key");
    section.text("family", rung.family, Need::optional, "rungs that differ in one size alone");
    section.quantity("size", rung.size, dim::none, Range::positive(), Need::optional,
                     "of the step, the mass factor, ...: what goes to zero in the family");
    section.flag("converged", rung.converged, "errors are counted from this rung");
    converged += rung.converged;
    for (std::size_t r = 0; r + 1 < ladder.rungs.size(); ++r)
      if (ladder.rungs[r].name == rung.name) section.fail("name", "another rung has this name; give each its own");
    if (!section.documenting() && rung.family.empty() != std::isnan(rung.size))
      section.fail(rung.family.empty() ? "size" : "family", "give family and size together, or neither");
  });
  if (!root.documenting() && converged != 1)
    root.fail("rung", fmt::format("{} of the rungs are converged; set converged = true in exactly one", converged));
  return ladder;
}

Ladder read(SceneDocument document) {
  Ladder ladder = visit(document.root());
  document.reject_unknown();
  return ladder;
}

std::string mass(double factor) {
  return fmt::format("integration.mass_scaling={:.17g}", factor);
}

/// Spring of a particle of mean size whose contacts are pressed as in a hot press [N/m].
double linear_stiffness(const dem::Scene& scene) {
  constexpr double elastic_overlap = 0.03;  // of the radius
  dem::PairTable table(scene.materials, scene.interfaces, scene.contact);
  table.update(scene.schedule.temperature(0), 0);
  const dem::PowderSample sample = dem::particles_of(scene);
  double mean = 0;
  for (const double d : sample.diameter) mean += 0.5 * d / double(sample.diameter.size());
  const std::uint8_t m = sample.material.front();
  return dem::with_spring(scene.contact, table.row(m, m),
                          [&](const auto& spring) { return spring.tangent(-elastic_overlap * mean, 0.5 * mean); });
}

/// The same powder with other numbers in a container of the same proportions; empty when it is not given by numbers.
std::vector<std::string> with_particles(const dem::Scene& scene, double share) {
  if (!scene.powder || scene.powder->total || scene.powder->components.size() != 1) return {};
  const auto* count = std::get_if<dem::ParticleCount>(&scene.powder->components[0].amount);
  if (!count || count->value * share < 50) return {};
  const double scale = std::cbrt(share);
  const auto& size = scene.container.size;
  std::vector<std::string> set{fmt::format("powder.1.number={:.0f}", std::floor(double(count->value) * share))};
  if (scene.container.shape == dem::ContainerShape::cylinder)
    set.push_back(fmt::format("specimen.diameter={:.9g} m", size[0] * scale));
  else if (scene.container.shape == dem::ContainerShape::box)
    set.push_back(fmt::format("specimen.size=[\"{:.9g} m\", \"{:.9g} m\"]", size[0] * scale, size[1] * scale));
  return set;
}

/// Rungs around the scene's own masses: real ones times a factor, or those that an accuracy chooses.
std::vector<Rung> rungs_of_masses(const dem::Scene& scene) {
  const dem::IntegrationSettings& own = scene.integration;
  const auto accuracy = [&](double value) {
    std::vector<std::string> set{fmt::format("integration.accuracy={:.17g}", value)};
    for (const char* key : {"mass_scaling", "inertia", "inertia_measure", "fixed_step", "largest_step", "smallest_step",
                            "load_steps", "skin"})
      set.push_back(fmt::format("integration.{}=", key));
    return set;
  };
  const auto named = [&](double value, bool converged) {
    return Rung{fmt::format("accuracy {:g}", value), accuracy(value), "accuracy", value, converged};
  };
  if (own.inertia == dem::Inertia::equalised) {
    const double middle = std::isnan(own.accuracy) ? 3e-3 : own.accuracy;
    std::vector<Rung> rungs{named(middle / 3, true), named(middle, false), named(std::min(0.1, middle * 3), false)};
    if (std::isnan(own.accuracy)) rungs.push_back({"the scene", {}, "", dem::unset, false});
    return rungs;
  }
  const std::string family = "mass factor";
  const double factor = own.mass_scaling;
  std::vector<Rung> rungs{{"mass factor / 10", {mass(factor / 10)}, family, factor / 10, true},
                          {"the scene", {}, family, factor, false},
                          {"mass factor x 10", {mass(factor * 10)}, family, factor * 10, false},
                          {"mass factor x 100", {mass(factor * 100)}, family, factor * 100, false}};
  if (own.method == dem::IntegrationMethod::inertia_free) return rungs;
  rungs.push_back(
      {"half the step", {fmt::format("integration.step_safety={:.17g}", own.step_safety / 2)}, "", dem::unset, false});
  for (const double value : {1e-3, 3e-3, 1e-2}) rungs.push_back(named(value, false));
  if (scene.contact.sintering && !scene.contact.friction)
    rungs.push_back({"without inertia", {"integration.method=inertia_free"}, "", dem::unset, false});
  return rungs;
}

}  // namespace

Ladder read_ladder(const std::filesystem::path& file) {
  return read(SceneDocument::from_file(file, {}));
}

Ladder read_ladder_text(std::string_view text) {
  return read(SceneDocument::from_text(text, "ladder.toml", {}));
}

std::string ladder_help() {
  SceneDocument document = SceneDocument::for_help();
  visit(document.root());
  return document.help_text();
}

Ladder built_in_ladder(const dem::Scene& scene) {
  Ladder ladder;
  ladder.rungs = rungs_of_masses(scene);
  const auto add = [&](const char* name, std::vector<std::string> set) {
    ladder.rungs.push_back({name, std::move(set), "", dem::unset, false});
  };
  if (scene.contact.sintering && scene.contact.sintering->model == dem::SinteringModel::viscoelastic)
    add("trapezoidal update", {"contact.sintering.update=trapezoidal"});
  if (scene.contact.elasticity == dem::Elasticity::hertz)
    add("linear springs",
        {"contact.elasticity=linear", fmt::format("contact.normal_stiffness={:.6g} N/m", linear_stiffness(scene)),
         "contact.hertz_radius=", "contact.stiffness_factor=", "walls.youngs_modulus=", "walls.poissons_ratio="});
  if (auto set = with_particles(scene, 0.25); !set.empty()) add("a quarter of the particles", set);
  if (auto set = with_particles(scene, 0.5); !set.empty()) add("half the particles", set);
  return ladder;
}

}  // namespace densify::app
