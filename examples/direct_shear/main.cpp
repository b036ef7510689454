// Direct shear test of cubical sand grains (chapter 3 of the thesis): packs grains into a box of two halves, loads a
// lid, shears one half over the other, and fits the angle of friction. See --help.
//
// Ends with 0 when all was done; 1 when the run ended early or a part of the report could not be made; 2 when the
// settings make no sense, before the results of an earlier run are touched; 130 after Ctrl-C or SIGTERM. What was found
// by then is saved and reported. Plots are drawn if gnuplot is there: a run without is as complete, and says so.

#include "campaign.hpp"
#include "old_results.hpp"
#include "report.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/geometry/polyhedron/polyhedron.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/symplectic_euler.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/io/file.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace {

/// Makes the output folder this run's own: says which results of an earlier one go, and takes them away.
void replace_old_results(const direct_shear::Settings& s, const std::string& config) {
  const auto settings = s.output / "settings.toml";
  if (const auto old = direct_shear::find_old_results(s.output); !old.empty()) {
    const bool same = std::filesystem::exists(settings) && dem::io::read_file(settings) == config;
    std::string names;
    for (const auto& path : old) names += (names.empty() ? "" : ", ") + path.filename().string();
    if (s.packing_file.empty() && std::filesystem::exists(s.save_packing)) {
      names += ", and " + s.save_packing + " once there is a new packing";
    }
    fmt::print(stderr, "Replacing what an earlier run with {} settings left in '{}': {}. Another --output keeps it.\n",
               same ? "the same" : "other", s.output.string(), names);
  }
  dem::io::write_file(settings, config);
  direct_shear::remove_old_results(s.output);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace direct_shear;
  namespace integrator = dem::integrator;
  try {
    Settings settings;
    std::string config;
    if (!read_settings(argc, argv, settings, config)) return 0;

    Campaign campaign;
    const auto begin = [&] { replace_old_results(settings, config); };
    using Cube8 = dem::shape::SphereCluster<8>;
    using Polyhedron = dem::shape::Polyhedron;
    using Superquadric = dem::shape::Superquadric;
    if (settings.shape == "polyhedron") run_campaign<integrator::VelocityVerlet, Polyhedron>(settings, campaign, begin);
    else if (settings.shape == "superquadric")
      run_campaign<integrator::VelocityVerlet, Superquadric>(settings, campaign, begin);
    else if (settings.integrator == "verlet")
      run_campaign<integrator::VelocityVerlet, Cube8>(settings, campaign, begin);
    else if (settings.integrator == "euler")
      run_campaign<integrator::SymplecticEuler, Cube8>(settings, campaign, begin);
    else run_campaign<integrator::PredictorCorrector, Cube8>(settings, campaign, begin);

    const bool complete = report(settings, campaign, config);
    if (!campaign.problem.empty()) fmt::print(stderr, "direct_shear: {}\n", campaign.problem);
    if (campaign.interrupted) return 130;
    return complete && campaign.problem.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "direct_shear: {}\n", error.what());
    return 2;
  }
}
