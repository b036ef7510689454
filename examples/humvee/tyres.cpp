#include "tyres.hpp"

#include <dem/io/csv.hpp>
#include <dem/report/plot.hpp>
#include <dem/vehicle/tyre_press.hpp>

#include <fmt/format.h>

#include <vector>

namespace hard_ground {

using dem::vehicle::RingTyreSpec;

void press_tyres(const std::string& folder) {
  const std::vector<double> pressures = {1.0e5, 1.7e5, 2.5e5, 3.4e5};
  // The tyre of Project Chrono's public HMMWV model, a 37 x 12.5 R 16.5: of its Fiala and of its TMeasy version.
  // Neither says at which pressure; the latter is for a load of 8.6 to 30 kN.
  const std::vector<std::pair<const char*, double>> published = {{"Chrono, Fiala", 3.263e5},
                                                                 {"Chrono, TMeasy", 4.111e5}};
  std::vector<double> deflections;
  for (int k = 1; k <= 8; ++k) deflections.push_back(0.01 * k);

  std::vector<std::string> columns = {"deflection_m"};
  std::vector<std::vector<double>> rows;
  for (const double d : deflections) rows.push_back({d});
  dem::io::Plot plot{.title = "A tyre of the Humvee on a plate", .x_label = "deflection [mm]", .y_label = "load [kN]"};
  fmt::print("\ntyres: load (kN) on a plate, length of the belt that touches (mm)\n  deflection (mm)");
  for (const double d : deflections) fmt::print("{:>12.0f}", 1e3 * d);
  for (const double pressure : pressures) {
    const RingTyreSpec spec{.pressure = pressure};
    dem::vehicle::TyrePress press(spec);
    const std::string name = fmt::format("{:g} bar", 1e-5 * pressure);
    dem::io::Series curve{.name = name};
    columns.push_back(fmt::format("load_{:g}_Pa_N", pressure));
    columns.push_back(fmt::format("length_{:g}_Pa_m", pressure));
    fmt::print("\n  {:<15}", name);
    for (std::size_t k = 0; k < deflections.size(); ++k) {
      // The mean over 5 mm about the deflection.
      const auto load = press.to(deflections[k] + 2.5e-3);
      rows[k].push_back(load.force), rows[k].push_back(load.length);
      curve.x.push_back(1e3 * deflections[k]), curve.y.push_back(1e-3 * load.force);
      fmt::print("{:>12}", fmt::format("{:.1f}, {:.0f}", 1e-3 * load.force, 1e3 * load.length));
    }
    plot.series.push_back(curve);
    fmt::print("  Rhyne: {:.0f} kN/m",
               1e-3 * dem::vehicle::rhyne_stiffness(pressure, spec.width, spec.radius, spec.rim_radius));
  }
  for (const auto& [name, stiffness] : published) {
    dem::io::Series line{.name = name, .x = {0.0}, .y = {0.0}};
    fmt::print("\n  {:<15}", name);
    for (const double d : deflections) {
      line.x.push_back(1e3 * d), line.y.push_back(1e-3 * stiffness * d);
      fmt::print("{:>12.1f}", 1e-3 * stiffness * d);
    }
    plot.series.push_back(line);
  }
  fmt::print("\n");
  dem::io::CsvWriter csv(folder + "/tyres.csv", columns);
  for (const auto& row : rows) csv.row(row);
  dem::io::render_plot(plot, folder + "/tyres_load");
}

}  // namespace hard_ground
